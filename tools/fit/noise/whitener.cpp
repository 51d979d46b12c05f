// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/whitener.h"

#include <array>
#include <cmath>
#include <vector>

namespace vernier::fit {
namespace {

/// Largest number of states of the filter: drift, run, pose.
constexpr int kStates = 3;

/// Logarithm of a product of variances, with one logarithm for many factors. Each factor is at least 1.
class LogProduct {
 public:
  void multiply(double factor) {
    product_ *= factor;
    if (product_ > kLarge) flush();
  }
  double value() {
    flush();
    return sum_;
  }

 private:
  static constexpr double kLarge = 1e200;  // a variance ratio is below 1e12: the product does not overflow
  void flush() {
    sum_ += std::log(product_);
    product_ = 1;
  }
  double product_ = 1, sum_ = 0;
};

/// The filter of one series. The covariance of the states does not depend on the readings, so all quantities
/// (columns of readings) share it. States without variance are left out. `kActive`: number of states.
template <int kActive>
class Filter {
 public:
  Filter(const NoiseSeries& series, const NoiseRatios& ratios, const std::array<int, kStates>& states)
      : series_(series), ratios_(ratios), states_(states) {}

  /// Whitens the readings of the series in place. Returns the logarithm of the determinant.
  double run(Eigen::MatrixXd& readings) {
    return readings.rows() == 1 ? run_rows<1>(readings) : run_rows<Eigen::Dynamic>(readings);
  }

  /// The steps of run(), each transposed, from the last reading to the first.
  void run_transposed(Eigen::MatrixXd& readings) {
    struct Step {
      std::array<double, kActive> factor, gain;
      double variance;
    };
    std::vector<Step> steps(series_.reading.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      Step& step = steps[i];
      step.factor.fill(1);
      predict(i, [&](int k, double factor) { step.factor[at(k)] *= factor; });
      step.variance = update();
      step.gain = gain_;
    }
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(readings.rows(), kActive);
    for (std::size_t i = steps.size(); i-- > 0;) {
      const Step& step = steps[i];
      auto reading = readings.col(series_.reading[i]);
      reading /= std::sqrt(step.variance);
      for (int k = 0; k < kActive; ++k) reading += step.gain[at(k)] * state.col(k);
      for (int k = 0; k < kActive; ++k) state.col(k) = step.factor[at(k)] * (state.col(k) - reading);
    }
  }

 private:
  /// `kRows`: number of quantities, if it is known to the compiler: one needs no vector.
  template <int kRows>
  double run_rows(Eigen::MatrixXd& readings) {
    LogProduct determinant;
    Eigen::Matrix<double, kRows, kActive> state =
        Eigen::Matrix<double, kRows, kActive>::Zero(readings.rows(), kActive);
    Eigen::Matrix<double, kRows, 1> innovation(readings.rows());
    for (std::size_t i = 0; i < series_.reading.size(); ++i) {
      predict(i, [&](int k, double factor) {
        if (factor == 0)
          state.col(k).setZero();
        else if (factor != 1)
          state.col(k) *= factor;
      });
      const double variance = update();
      auto reading = readings.col(series_.reading[i]).template head<kRows>(readings.rows());
      innovation = reading;
      for (int k = 0; k < kActive; ++k) innovation -= state.col(k);
      for (int k = 0; k < kActive; ++k) state.col(k) += gain_[at(k)] * innovation;
      reading = innovation / std::sqrt(variance);
      determinant.multiply(variance);
    }
    return determinant.value();
  }

  static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }

  /// Moves the states from the reading before to reading `i`. `scale(k, factor)`: multiplies state k.
  template <class Scale>
  void predict(std::size_t i, const Scale& scale) {
    const bool new_setup = i == 0 || series_.setup[i] != series_.setup[i - 1];
    const bool new_clock = i == 0 || series_.clock[i] != series_.clock[i - 1];
    const bool new_pose = new_setup || series_.pose[i] != series_.pose[i - 1];
    for (int k = 0; k < kActive; ++k) {
      if (states_[at(k)] == 0 && !new_clock) {
        const double rho = decay(i);
        for (int l = 0; l < kActive; ++l) {
          p_[at(k)][at(l)] *= rho;
          p_[at(l)][at(k)] *= rho;
        }
        p_[at(k)][at(k)] += (1 - rho * rho) * ratios_.drift;
        scale(k, rho);
      } else if (states_[at(k)] == 0) {
        begin(k, ratios_.drift, scale);
      } else if (states_[at(k)] == 1 && new_setup) {
        begin(k, ratios_.run, scale);
      } else if (states_[at(k)] == 2 && new_pose) {
        begin(k, ratios_.pose, scale);
      }
    }
  }

  template <class Scale>
  void begin(int k, double variance, const Scale& scale) {
    for (int l = 0; l < kActive; ++l) p_[at(k)][at(l)] = p_[at(l)][at(k)] = 0;
    p_[at(k)][at(k)] = variance;
    scale(k, 0.0);
  }

  /// Takes one reading into the covariance. Returns the variance of the reading, given the readings before.
  double update() {
    double variance = 1;
    for (int k = 0; k < kActive; ++k) {
      double sum = 0;
      for (int l = 0; l < kActive; ++l) sum += p_[at(k)][at(l)];
      gain_[at(k)] = sum;
      variance += sum;
    }
    for (int k = 0; k < kActive; ++k) gain_[at(k)] /= variance;
    for (int k = 0; k < kActive; ++k)
      for (int l = 0; l < kActive; ++l) p_[at(k)][at(l)] -= variance * gain_[at(k)] * gain_[at(l)];
    return variance;
  }

  /// Correlation of the drift at two successive readings. Intervals are often equal.
  double decay(std::size_t i) {
    const double interval = passed(series_, i, ratios_.in_time);
    if (interval != interval_) {
      interval_ = interval;
      rho_ = std::exp(-interval / ratios_.time_constant);
    }
    return rho_;
  }

  const NoiseSeries& series_;
  const NoiseRatios& ratios_;
  std::array<int, kStates> states_;  // 0: drift, 1: run, 2: pose
  std::array<std::array<double, kActive>, kActive> p_{};
  std::array<double, kActive> gain_{};
  double interval_ = 0, rho_ = 1;
};

/// Calls use(filter) with the filter of a series, unless its readings are independent.
template <class Use>
void with_filter(const NoiseSeries& series, const NoiseRatios& ratios, const Use& use) {
  std::array<int, kStates> states{};
  int active = 0;
  const auto take = [&](int state, double variance) {
    if (variance > 0) states[static_cast<std::size_t>(active++)] = state;
  };
  take(0, is_drifting(ratios.drifts, series.kind) ? ratios.drift : 0);
  take(1, ratios.run);
  take(2, ratios.pose);
  if (active == 1) use(Filter<1>(series, ratios, states));
  if (active == 2) use(Filter<2>(series, ratios, states));
  if (active == 3) use(Filter<3>(series, ratios, states));
}

}  // namespace

double whiten(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings) {
  double log_det = 0;
  for (const NoiseSeries& series : layout.series)
    with_filter(series, ratios, [&](auto filter) { log_det += filter.run(readings); });
  return log_det;
}

void whiten_transposed(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings) {
  for (const NoiseSeries& series : layout.series)
    with_filter(series, ratios, [&](auto filter) { filter.run_transposed(readings); });
}

}  // namespace vernier::fit
