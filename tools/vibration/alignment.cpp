// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/alignment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/maths/median.h"
#include "tools/text/error.h"
#include "tools/vibration/fourier.h"

namespace vernier::vibration {
namespace {

void check(const Series& series) {
  if (series.t_s.size() < 16 || series.value.size() != series.t_s.size())
    throw text::InputError("the record has fewer than 16 samples and cannot be aligned");
  if (std::adjacent_find(series.t_s.begin(), series.t_s.end(), std::greater_equal<>()) != series.t_s.end())
    throw text::InputError("a record whose times do not increase cannot be aligned");
}

/// Cubic through value and slope of both neighbours. t is limited to the record.
double at(const Series& s, double t) {
  t = std::clamp(t, s.t_s.front(), s.t_s.back());
  const auto next = std::upper_bound(s.t_s.begin() + 1, s.t_s.end() - 1, t);
  const auto i = static_cast<std::size_t>(next - s.t_s.begin()) - 1, last = s.t_s.size() - 1;
  const auto secant = [&s](std::size_t a, std::size_t b) {
    return (s.value[b] - s.value[a]) / (s.t_s[b] - s.t_s[a]);
  };
  const double h = s.t_s[i + 1] - s.t_s[i], u = (t - s.t_s[i]) / h;
  const double m0 = secant(i == 0 ? 0 : i - 1, i + 1) * h, m1 = secant(i, std::min(i + 2, last)) * h;
  const double rise = s.value[i + 1] - s.value[i];
  return s.value[i] + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise)));
}

struct ValueAndSlope {
  double value, slope;
};

double median_step(const Series& s) {
  std::vector<double> steps(s.t_s.size());
  std::adjacent_difference(s.t_s.begin(), s.t_s.end(), steps.begin());
  steps.erase(steps.begin());  // the first time itself
  return maths::median(std::move(steps));
}

/// Returns values at even steps from the first time on, without their mean.
std::vector<double> resampled(const Series& s, double step) {
  std::vector<double> even;
  for (std::size_t i = 0; s.t_s.front() + static_cast<double>(i) * step <= s.t_s.back(); ++i)
    even.push_back(at(s, s.t_s.front() + static_cast<double>(i) * step));
  const double mean = std::accumulate(even.begin(), even.end(), 0.0) / static_cast<double>(even.size());
  for (double& value : even) value -= mean;
  return even;
}

/// Sums of squares up to each sample.
std::vector<double> energies(const std::vector<double>& x) {
  std::vector<double> sum(x.size() + 1, 0);
  for (std::size_t i = 0; i < x.size(); ++i) sum[i + 1] = sum[i] + x[i] * x[i];
  return sum;
}

/// Correlation of a[i + lag] with b[i] over their overlap, for each lag with an overlap of at
/// least half the shorter one.
struct Lagged {
  long lag;
  double correlation;
};
std::vector<Lagged> correlations(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t size = a.size() + b.size();
  Fourier fourier(size);
  std::vector<double> padded(size, 0);
  std::copy(a.begin(), a.end(), padded.begin());
  const auto fa = fourier.forward(padded);
  std::vector<std::complex<double>> product(fa.begin(), fa.end());
  std::fill(padded.begin(), padded.end(), 0);
  std::copy(b.begin(), b.end(), padded.begin());
  const auto fb = fourier.forward(padded);
  for (std::size_t k = 0; k < product.size(); ++k) product[k] *= std::conj(fb[k]);
  const auto sums = fourier.backward(product);
  const std::vector<double> ea = energies(a), eb = energies(b);
  const auto na = static_cast<long>(a.size()), nb = static_cast<long>(b.size());
  std::vector<Lagged> all;
  for (long lag = 1 - nb; lag < na; ++lag) {
    const long from = std::max(0L, -lag), to = std::min(nb, na - lag);  // of b
    if (2 * (to - from) < std::min(na, nb)) continue;
    const auto energy = [](const std::vector<double>& e, long low, long high) {
      return e[static_cast<std::size_t>(high)] - e[static_cast<std::size_t>(low)];
    };
    const double scale = std::sqrt(energy(ea, from + lag, to + lag) * energy(eb, from, to));
    const auto place = static_cast<std::size_t>(lag < 0 ? lag + static_cast<long>(size) : lag);
    if (scale > 0) all.push_back({lag, sums[place] / scale});
  }
  return all;
}

/// Returns the best lag. `second_best` gets the best of the other maxima.
Lagged best_lag(const std::vector<Lagged>& all, double& second_best) {
  if (all.empty())
    throw text::InputError("the records cannot be aligned, because one record contains no motion");
  const auto best = std::max_element(
      all.begin(), all.end(), [](const Lagged& a, const Lagged& b) { return a.correlation < b.correlation; });
  second_best = 0;
  const auto is_top = [&](std::size_t i) {
    return i > 0 && i + 1 < all.size() && all[i].correlation >= all[i - 1].correlation &&
           all[i].correlation > all[i + 1].correlation;
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_top(i) && std::labs(all[i].lag - best->lag) > 2)
      second_best = std::max(second_best, all[i].correlation);
  return *best;
}

/// Returns the number of lags to either side of the best one until the correlation is nine tenths
/// of it.
long width_of(const std::vector<Lagged>& all, const Lagged& best) {
  long width = 1;
  for (const Lagged& one : all)
    if (one.lag > best.lag && one.correlation > 0.9 * best.correlation && one.lag == best.lag + width)
      ++width;
  return width;
}

/// Least squares of reference = gain other((t - offset)/rate) + mean over the reference's samples in a
/// window.
class ClockProblem {
 public:
  /// `slope_step`: distance to either side over which slopes are taken, s. The slopes use other
  /// samples. If they contained the noise of the sample itself, they would be correlated with its
  /// residual and the clock would be biased.
  ClockProblem(const Series& reference, const Series& other, double slope_step)
      : reference_(reference), other_(other), slope_step_(slope_step) {}

  /// Improves `fit`. Its clock is taken about `centre` (reference time) to decouple offset and
  /// rate.
  void solve(ClockFit& fit, double centre, double half_width) const {
    double shift = 0;  // t_other of the centre
    shift = (centre - fit.offset_s) / fit.rate;
    double slowness = 1 / fit.rate;
    for (int step = 0; step < 30; ++step) {
      Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
      Eigen::Vector4d right = Eigen::Vector4d::Zero();
      const Sums sums = line_through(centre, half_width, shift, slowness);
      if (sums.n < 8) return;
      double square = 0, total = 0;
      each(centre, half_width, shift, slowness, [&](double from_centre, double measured, ValueAndSlope o) {
        const Eigen::Vector4d row(sums.gain * o.slope, sums.gain * o.slope * from_centre, o.value, 1);
        const double residual = measured - sums.gain * o.value - sums.mean;
        normal += row * row.transpose();
        right += row * residual;
        square += residual * residual;
        total += (measured - sums.reference_mean) * (measured - sums.reference_mean);
      });
      const Eigen::Vector4d scale = normal.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::Matrix4d inverse = (scale.asDiagonal() * normal * scale.asDiagonal()).inverse();
      const Eigen::Vector4d move = scale.asDiagonal() * inverse * scale.asDiagonal() * right;
      if (!move.allFinite()) return;
      shift += move[0];
      slowness += move[1];
      const double variance = square / std::max(1.0, sums.n - 4);
      fit.offset_std_s = scale[0] * std::sqrt(inverse(0, 0) * variance);
      fit.rate_std = scale[1] * std::sqrt(inverse(1, 1) * variance);
      fit.correlation = total > 0 ? std::sqrt(std::max(0.0, 1 - square / total)) : 0;
      if (std::fabs(move[0]) < 1e-3 * fit.offset_std_s && std::fabs(move[1]) < 1e-3 * fit.rate_std) break;
    }
    fit.rate = 1 / slowness;
    fit.offset_s = centre - shift * fit.rate;
  }

 private:
  struct Sums {
    double n = 0, gain = 1, mean = 0, reference_mean = 0;
  };

  template <class Visit>
  void each(double centre, double half_width, double shift, double slowness, const Visit& visit) const {
    for (std::size_t i = 0; i < reference_.t_s.size(); ++i) {
      const double from_centre = reference_.t_s[i] - centre, t = shift + slowness * from_centre;
      if (std::fabs(from_centre) > half_width || t < other_.t_s.front() || t > other_.t_s.back()) continue;
      const double slope = (at(other_, t + slope_step_) - at(other_, t - slope_step_)) / (2 * slope_step_);
      visit(from_centre, reference_.value[i], {at(other_, t), slope});
    }
  }

  Sums line_through(double centre, double half_width, double shift, double slowness) const {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    each(centre, half_width, shift, slowness, [&](double, double measured, ValueAndSlope o) {
      n += 1, x += o.value, y += measured, xx += o.value * o.value, xy += o.value * measured;
    });
    Sums sums{n, 1, 0, n > 0 ? y / n : 0};
    const double spread = n * xx - x * x;
    if (spread > 0) sums.gain = (n * xy - x * y) / spread, sums.mean = (y - sums.gain * x) / n;
    return sums;
  }

  const Series& reference_;
  const Series& other_;
  double slope_step_;
};

}  // namespace

ClockFit align_clocks(const Series& reference, const Series& other) {
  check(reference), check(other);
  const double longest =
      std::max(reference.t_s.back() - reference.t_s.front(), other.t_s.back() - other.t_s.front());
  constexpr double kMostSteps = 1 << 20;  // of a correlation: seconds of work and 100 MB
  const double step = std::max(std::min(median_step(reference), median_step(other)), longest / kMostSteps);
  ClockFit fit;
  const std::vector<Lagged> lags = correlations(resampled(reference, step), resampled(other, step));
  const Lagged best = best_lag(lags, fit.second_best);
  fit.offset_s = reference.t_s.front() + static_cast<double>(best.lag) * step - other.t_s.front();
  const double from = std::max(reference.t_s.front(), other.t_s.front() + fit.offset_s);
  const double to = std::min(reference.t_s.back(), other.t_s.back() + fit.offset_s);
  const double centre = (from + to) / 2;
  const ClockProblem problem(reference, other, static_cast<double>(width_of(lags, best) + 1) * step);
  for (const double part : {0.125, 0.25, 0.5, 1.0}) problem.solve(fit, centre, part * (to - from) / 2);
  if (fit.correlation < 0.5)
    throw text::InputError("the records have no motion in common: correlation below 0.5");
  return fit;
}

std::vector<PathPlace> nearest_places(const Eigen::MatrixXd& path, const Eigen::MatrixXd& points,
                                      double reach) {
  if (path.cols() < 2 || path.rows() != points.rows())
    throw text::InputError("a path must have at least two samples of the same axes");
  std::vector<PathPlace> places;
  PathPlace last;
  for (Eigen::Index p = 0; p < points.cols(); ++p) {
    PathPlace best{last.sample, last.fraction, HUGE_VAL};
    double gone = 0;
    for (auto i = static_cast<Eigen::Index>(last.sample); i + 1 < path.cols() && gone <= reach; ++i) {
      const Eigen::VectorXd along = path.col(i + 1) - path.col(i), to = points.col(p) - path.col(i);
      const double length2 = along.squaredNorm();
      const double first = i == static_cast<Eigen::Index>(last.sample) ? last.fraction : 0;
      const double u = length2 > 0 ? std::clamp(along.dot(to) / length2, first, 1.0) : first;
      const double distance = (to - u * along).norm();
      if (distance < best.distance) best = {static_cast<std::size_t>(i), u, distance};
      gone += std::sqrt(length2) * (1 - first);
    }
    places.push_back(best);
    last = best;
  }
  return places;
}

}  // namespace vernier::vibration
