// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/noise_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "tools/fit/noise/whitener.h"
#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/median.h"

namespace vernier::fit {
namespace {

/// Returns the decrease of -2 log likelihood that a noise component without a cause reaches with the
/// probability `chance`. A component has a standard deviation, which is 0 without it and thus at the end of
/// its range, and `parameters` - 1 others: half of the decreases have the chi-square distribution of
/// `parameters`, half that of one fewer (Self and Liang 1987; none: no decrease).
double needed_decrease(double chance, int parameters) {
  const auto tail = [parameters](double x) {
    return (maths::chi_square_tail(x, parameters) +
            (parameters > 1 ? maths::chi_square_tail(x, parameters - 1) : 0)) /
           2;
  };
  double low = 0, high = 100;
  for (int step = 0; step < 50; ++step) (tail((low + high) / 2) > chance ? low : high) = (low + high) / 2;
  return high;
}

/// -2 log of the restricted likelihood as a function of the ratios, with the independent part at
/// its best value.
class Likelihood {
 public:
  Likelihood(const NoiseLayout& layout, const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted,
             double least_own)
      : layout_(layout),
        least_variance_(least_own * least_own),
        freedom_(static_cast<double>(residual.size() - fitted.cols())) {
    const auto n = static_cast<double>(residual.size()), k = static_cast<double>(fitted.cols());
    const bool whole = n * k * k < kMostNoiseProducts;
    const Eigen::Index columns = whole ? fitted.cols() : 0;
    readings_.resize(columns + 1, residual.size());
    if (columns > 0) readings_.topRows(columns) = fitted.transpose();
    readings_.row(columns) = residual.transpose();
  }

  double operator()(const NoiseRatios& ratios, double* own = nullptr) const {
    Eigen::MatrixXd w = readings_;
    double value = whiten(layout_, ratios, w);
    const Eigen::Index k = w.rows() - 1;
    double squares = w.row(k).squaredNorm();
    if (k > 0) {
      const Eigen::MatrixXd normal = w.topRows(k) * w.topRows(k).transpose();
      const Eigen::LLT<Eigen::MatrixXd> factor(normal);
      if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
      const Eigen::VectorXd moment = w.topRows(k) * w.row(k).transpose();
      squares -= moment.dot(factor.solve(moment));
      value += 2 * factor.matrixLLT().diagonal().array().log().sum();
    }
    const double variance = std::max(std::max(squares, 1e-300) / freedom_, least_variance_);
    if (own != nullptr) *own = std::sqrt(variance);
    return value + freedom_ * std::log(variance) + squares / variance;
  }

 private:
  const NoiseLayout& layout_;
  double least_variance_;  // of the independent part
  double freedom_;
  Eigen::MatrixXd readings_;
};

/// The active components, and the logarithms of their ratios and of the time constant.
struct NoiseParts {
  bool pose = false, run = false, drift = false, in_time = false;
  std::uint32_t drifts = 0;  // kinds that drift; 0: all
  std::array<double, 4> log = {0, 0, 0, 0};

  NoiseRatios ratios() const {
    return {pose ? std::exp(log[0]) : 0,
            run ? std::exp(log[1]) : 0,
            drift ? std::exp(log[2]) : 0,
            std::exp(log[3]),
            in_time,
            drifts};
  }
};

/// The sets of kinds that may drift: all (0), one alone, all but one. A kind alone needs enough readings:
/// with few of them a drift fits any error.
std::vector<std::uint32_t> sets_that_drift(const NoiseLayout& layout, const NoiseThresholds& limits) {
  std::vector<std::uint32_t> sets = {0};
  if (layout.series.size() < 2) return sets;
  std::uint32_t all = 0;
  for (const NoiseSeries& series : layout.series) all |= 1U << series.kind;
  for (const NoiseSeries& series : layout.series)
    if (series.reading.size() >= limits.least_freedom) sets.push_back(1U << series.kind);
  for (const NoiseSeries& series : layout.series)
    if (layout.series.size() > 2) sets.push_back(all & ~(1U << series.kind));
  return sets;
}

/// Limit for variances: a component that is 3e5 times another dominates completely.
constexpr double kMostLogRatio = 25;

/// Minimises along each coordinate in turn with decreasing steps. There are few parameters and the
/// function is smooth.
double descend(const Likelihood& likelihood, NoiseParts& parts, double best, double least_log_time,
               double most_log_time) {
  const std::array<bool, 4> free = {parts.pose, parts.run, parts.drift, parts.drift};
  for (double step = 1; step > 0.1; step /= 2)
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < free.size(); ++i) {
        if (!free[i]) continue;
        for (const double sign : {step, -step}) {
          NoiseParts trial = parts;
          trial.log[i] = std::clamp(trial.log[i] + sign, -kMostLogRatio, kMostLogRatio);
          trial.log[3] = std::clamp(trial.log[3], least_log_time, most_log_time);
          const double value = likelihood(trial.ratios());
          if (!(value < best - 1e-3)) continue;  // also where it is not a number
          best = value;
          parts = trial;
          moved = true;
          break;
        }
      }
    }
  return best;
}

/// A step of the instrument at one row, in the kinds of reading that show it.
struct StepsAtRow {
  std::vector<NoiseStep> steps;
  double net = 0;  // decrease of the sum of squares minus the penalty of the steps
};

/// Returns the decrease of the sum of squares by a step at each row of a series, except the first
/// and last rows of a run.
std::vector<std::pair<NoiseStep, double>> steps_of(const NoiseSeries& series, const Eigen::VectorXd& residual,
                                                   const Eigen::MatrixXd& fitted,
                                                   const NoiseThresholds& limits) {
  const std::size_t least_rows = limits.rows_beside_step;
  // A step at the start of a run is a set-up. Machine files have a name for it.
  std::vector<char> near_set_up(series.reading.size(), 0);
  for (std::size_t i = 1; i < series.reading.size(); ++i)
    if (series.setup[i] != series.setup[i - 1])
      for (std::size_t k = i - std::min(i, least_rows); k < std::min(i + least_rows, near_set_up.size()); ++k)
        near_set_up[k] = 1;
  std::vector<std::pair<NoiseStep, double>> list;
  double sum = 0, count = 0;
  Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(fitted.cols());
  for (std::size_t i = series.reading.size(); i-- > 0;) {
    sum += residual[series.reading[i]];
    along += fitted.row(series.reading[i]);
    ++count;
    if (i < least_rows || i + least_rows > series.reading.size() || near_set_up[i] != 0) continue;
    const double own = count - along.squaredNorm();
    if (own < limits.own_of_step * count) continue;
    NoiseStep step{series.kind, series.row[i], sum / own, 1 / std::sqrt(own)};
    step.unit = series.unit[i];
    list.emplace_back(step, sum * sum / own);
  }
  return list;
}

/// Returns the row at which a step lowers the sum of squares most beyond its penalty. An
/// instrument that is moved usually moves in all directions together. `unit`: penalty of one
/// number.
StepsAtRow best_steps(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                      const Eigen::MatrixXd& fitted, double unit, const NoiseThresholds& limits) {
  std::map<std::size_t, StepsAtRow> of_row;
  for (const NoiseSeries& series : layout.series)
    for (const auto& [step, gain] : steps_of(series, residual, fitted, limits)) {
      if (gain < unit) continue;
      StepsAtRow& at = of_row[step.row];
      at.steps.push_back(step);
      at.net += gain - unit;
    }
  StepsAtRow best;
  for (auto& [row, at] : of_row) {
    at.net -= kPriceOfPlace * unit;
    if (at.net > best.net) best = std::move(at);
  }
  return best;
}

/// Returns a residual with its values limited to this number of robust standard deviations. A
/// single outlier is not a property of the noise.
Eigen::VectorXd held(const Eigen::VectorXd& residual, double spreads) {
  const double most = spreads * maths::robust_spread({residual.begin(), residual.end()});
  if (most <= 0) return residual;
  return residual.cwiseMax(-most).cwiseMin(most);
}

NoiseModel estimate_components(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                               const Eigen::MatrixXd& fitted, double least_own,
                               const NoiseThresholds& limits) {
  NoiseModel model;
  model.in_time = layout.in_time;
  if (residual.size() - fitted.cols() < static_cast<Eigen::Index>(limits.least_freedom) ||
      residual.squaredNorm() <= 0)
    return model;
  const Likelihood likelihood(layout, held(residual, limits.held), fitted, least_own);
  const double least_log_time = std::log(layout.step), most_log_time = std::log(10 * layout.span);
  NoiseParts parts;
  parts.in_time = layout.in_time;
  const double white = likelihood(parts.ratios());
  double best = white;
  constexpr std::array<double, 5> kLogRatios = {-3, -1.5, 0, 1.5, 3};
  const double one_needed = needed_decrease(limits.chance, 1),
               drift_needed = needed_decrease(limits.chance, 2);
  // Adds one component after the other, the one with the largest decrease first.
  for (int round = 0; round < 3; ++round) {
    NoiseParts next = parts;
    double next_value = best, gain = 0;
    const auto offer = [&](const NoiseParts& start, double needed) {
      NoiseParts trial = start;
      const double value =
          descend(likelihood, trial, likelihood(trial.ratios()), least_log_time, most_log_time);
      if (best - value - needed <= gain) return;
      gain = best - value - needed;
      next = trial;
      next_value = value;
    };
    const auto best_start = [&](const std::vector<NoiseParts>& starts) {
      const NoiseParts* least = nullptr;
      double value = 0;
      for (const NoiseParts& start : starts) {
        const double at = likelihood(start.ratios());
        if (least != nullptr && at >= value) continue;
        least = &start;
        value = at;
      }
      return *least;
    };
    std::vector<NoiseParts> starts;
    if (!parts.pose && layout.has_poses) {
      for (const double log : kLogRatios) {
        starts.push_back(parts);
        starts.back().pose = true;
        starts.back().log[0] = log;
      }
      offer(best_start(starts), one_needed);
    }
    if (!parts.run && layout.has_runs) {
      starts.clear();
      for (const double log : kLogRatios) {
        starts.push_back(parts);
        starts.back().run = true;
        starts.back().log[1] = log;
      }
      offer(best_start(starts), one_needed);
    }
    if (!parts.drift) {
      constexpr double kTimeSteps = 1.2;  // of the logarithm of a time constant: a factor of 3.3
      for (const std::uint32_t drifts : sets_that_drift(layout, limits)) {
        starts.clear();
        for (double time = least_log_time + kTimeSteps; time <= most_log_time; time += kTimeSteps)
          for (const double log : kLogRatios) {
            starts.push_back(parts);
            starts.back().drift = true;
            starts.back().drifts = drifts;
            starts.back().log[2] = log;
            starts.back().log[3] = time;
          }
        const double choice = drifts == 0 ? 0 : 2 * std::log(static_cast<double>(layout.series.size()));
        if (!starts.empty()) offer(best_start(starts), drift_needed + choice);
      }
    }
    if (gain <= 0) break;
    parts = next;
    best = next_value;
  }
  if (parts.drift && layout.in_time) {
    // A drift that depends on the number of readings, not on the time between them.
    NoiseParts by_rows = parts;
    by_rows.in_time = false;
    by_rows.log[3] = std::clamp(parts.log[3] - std::log(layout.step), 0.0, std::log(10 * layout.row_span));
    const double value =
        descend(likelihood, by_rows, likelihood(by_rows.ratios()), 0, std::log(10 * layout.row_span));
    if (value < best - one_needed) {
      parts = by_rows;
      best = value;
    }
  }
  model.in_time = parts.in_time;
  likelihood(parts.ratios(), &model.own);
  const NoiseRatios ratios = parts.ratios();
  model.pose = model.own * std::sqrt(ratios.pose);
  model.run = model.own * std::sqrt(ratios.run);
  model.drift = model.own * std::sqrt(ratios.drift);
  model.time_constant = parts.drift ? ratios.time_constant : 0;
  model.drifts = parts.drift ? parts.drifts : 0;
  model.support = white - best;
  model.log_likelihood = -best / 2;
  return model;
}

/// Returns independent noise of the size of the residual.
NoiseModel white_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                       const Eigen::MatrixXd& fitted, double least_own, const NoiseThresholds& limits) {
  NoiseModel model;
  model.in_time = layout.in_time;
  if (residual.size() <= fitted.cols()) return model;  // no reading is left over to show any noise
  const Likelihood likelihood(layout, held(residual, limits.held), fitted, least_own);
  model.log_likelihood = -likelihood({}, &model.own) / 2;
  return model;
}

/// Returns nullopt if the independent noise is negligible. The residual is then model error. If u
/// is given, u states the whole error of a reading, including its common components: if the readings are
/// better than u, their components have the size of u, in the same ratios. If they are much better than
/// stated, u counts as independent noise.
std::optional<NoiseModel> estimate_beside(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                                          const Eigen::MatrixXd& fitted, bool with_u,
                                          const NoiseThresholds& limits) {
  // Readings without noise: a likelihood would fit their rounding.
  const double scatter =
      residual.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, residual.size())));
  if (with_u && scatter < limits.far_below_u) return white_noise(layout, residual, fitted, 1, limits);
  // Exact copies of a reading have no independent noise, and no ratio to it.
  const double least_own = with_u ? limits.far_below_u : 0;
  NoiseModel free = estimate_components(layout, residual, fitted, least_own, limits);
  if (!with_u) return free.own < limits.least_own_part * free.shared() ? std::nullopt : std::optional(free);
  if (free.log_likelihood == 0) return free;  // too few readings, or no residual
  if (free.independent()) return white_noise(layout, residual, fitted, 1, limits);
  // A drift that is longer than the record can be large and leave a small scatter.
  const double seen = std::min(free.total(), white_noise(layout, residual, fitted, 0, limits).own);
  if (seen < limits.levels.most) return estimate_components(layout, residual, fitted, 1, limits);
  const double scale = std::max(1.0, 1 / free.total());
  for (double* part : {&free.own, &free.pose, &free.run, &free.drift}) *part *= scale;
  return free;
}

/// Heights of all steps in one least-squares fit beside the fitted directions: each was found without the
/// later ones.
void set_heights(const NoiseLayout& layout, const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted,
                 std::vector<NoiseStep>& steps) {
  Eigen::MatrixXd columns = step_columns(layout, steps, residual.size());
  for (int pass = 0; pass < 2; ++pass) columns -= fitted * (fitted.transpose() * columns);
  const Eigen::VectorXd heights = maths::least_norm(columns, residual);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].height = heights[static_cast<Eigen::Index>(k)];
}

}  // namespace

NoiseModel estimate_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& fitted, bool with_u, const NoiseThresholds& limits) {
  const std::optional<NoiseModel> alone = estimate_beside(layout, residual, fitted, with_u, limits);
  if (!alone) return white_noise(layout, residual, fitted, 0, limits);
  const NoiseModel& without = *alone;
  // Adds steps of the instrument one after the other. Each must explain more than chance at that
  // number of rows. They are accepted only if the whole is better than a drift without them.
  const auto n = static_cast<double>(residual.size());
  std::vector<NoiseStep> steps;
  Eigen::VectorXd left = residual;
  Eigen::MatrixXd all = fitted;
  for (std::size_t place = 0; place < limits.most_steps; ++place) {
    const double variance = left.squaredNorm() / std::max(1.0, n - static_cast<double>(all.cols()));
    const StepsAtRow best = best_steps(layout, left, all, std::log(n) * std::max(variance, 1e-300), limits);
    if (best.steps.empty()) break;
    for (const NoiseStep& step : best.steps) {
      Eigen::VectorXd column = step_columns(layout, {step}, residual.size());
      for (int pass = 0; pass < 2; ++pass) column -= all * (all.transpose() * column);
      if (column.norm() < 1e-6) continue;
      steps.push_back(step);
      column.normalize();
      all.conservativeResize(Eigen::NoChange, all.cols() + 1);
      all.rightCols(1) = column;
      left -= column * column.dot(left);
    }
  }
  if (steps.empty()) return without;
  set_heights(layout, residual, fitted, steps);
  std::optional<NoiseModel> beside = estimate_beside(layout, left, all, with_u, limits);
  if (!beside) return without;
  NoiseModel& with = *beside;
  for (NoiseStep& step : steps) step.std *= with.own;
  with.steps = std::move(steps);
  const auto criterion = [&](const NoiseModel& model) {
    return model.price() * std::log(n) - 2 * model.log_likelihood;
  };
  if (criterion(with) >= criterion(without)) return without;
  with.support += 2 * (with.log_likelihood - without.log_likelihood) + without.support;
  return with;
}

}  // namespace vernier::fit
