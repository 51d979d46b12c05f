// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"

namespace vernier::fit {
namespace {

/// Steps between rows below this share of an axis' range may be the same pose read again; what separates them
/// from real steps is a gap of at least this factor.
constexpr double kSmallStep = 1e-2, kPoseGap = 20, kNoStep = 1e-9;
/// Fall of -2 log likelihood at which a component is no chance: one parameter on its boundary, and two (chi^2
/// tails of 1e-3).
constexpr double kOneComponent = 9.5, kDriftComponent = 13;
/// Price of a step in units of the logarithm of the readings: its place among all rows, beside 1 for its
/// height in each kind of reading.
constexpr double kPriceOfPlace = 2;

/// Where no u is given and next to nothing is a reading's own, what is left is smooth: what the model lacks,
/// no noise.
constexpr double kLeastOwnPart = 0.02;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Largest share of its range that any axis moves from one row to the next.
std::vector<double> relative_steps(const model::Measurement& m, const std::vector<model::Column>& axes) {
  std::vector<double> steps(m.rows(), 1);
  std::vector<double> range;
  for (const model::Column& axis : axes)
    range.push_back(axis.size() > 0 ? std::max(axis.maxCoeff() - axis.minCoeff(), 1e-12) : 1);
  for (std::size_t row = 1; row < m.rows(); ++row) {
    double largest = 0;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(row);
      largest = std::max(largest, std::abs(axes[a][at] - axes[a][at - 1]) / range[a]);
    }
    const model::Labels& setup = m.states.setup;
    steps[row] = m.states.of(setup, row) == m.states.of(setup, row - 1) ? largest : 1;
  }
  return steps;
}

/// Below it a step is none: where the sizes of steps have their widest gap; 0 where they have none.
double pose_tolerance(const std::vector<double>& steps) {
  std::vector<double> sorted = steps;
  for (double& step : sorted) step = std::max(step, kNoStep);
  std::sort(sorted.begin(), sorted.end());
  double widest = kPoseGap, tolerance = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i - 1] > kSmallStep) break;
    const double gap = sorted[i] / sorted[i - 1];
    if (gap <= widest) continue;
    widest = gap;
    tolerance = std::sqrt(sorted[i] * sorted[i - 1]);
  }
  return tolerance;
}

/// The parts of a model, relative to the own one: squares.
struct Ratios {
  double pose = 0, run = 0, drift = 0, time_constant = 1;
  bool in_time = false;  // else the time constant is a number of rows
};

/// What passes between a reading of a series and the one before it, s or rows.
double passed(const NoiseSeries& series, std::size_t i, bool in_time) {
  return in_time ? series.time[i] - series.time[i - 1]
                 : static_cast<double>(series.row[i]) - static_cast<double>(series.row[i - 1]);
}

/// Kalman filter of three states (drift, run, pose) shared by all columns; the own part has variance 1.
class Whitener {
 public:
  Whitener(const NoiseLayout& layout, const Ratios& ratios) : layout_(layout), ratios_(ratios) {}

  /// rows x columns, transposed: a reading is a column. Returns log det.
  double run(Eigen::MatrixXd& readings) {
    double log_det = 0;
    for (const NoiseSeries& series : layout_.series) log_det += run(series, readings);
    return log_det;
  }

 private:
  double run(const NoiseSeries& series, Eigen::MatrixXd& readings) {
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(readings.rows(), 3);
    Eigen::Matrix3d p = Eigen::Matrix3d::Zero();
    double log_det = 0;
    Eigen::VectorXd innovation(readings.rows());
    for (std::size_t i = 0; i < series.reading.size(); ++i) {
      const bool new_setup = i == 0 || series.setup[i] != series.setup[i - 1];
      if (new_setup) begin(state, p, 1, ratios_.run);
      if (i == 0 || series.clock[i] != series.clock[i - 1]) {
        begin(state, p, 0, ratios_.drift);
      } else if (ratios_.drift > 0) {
        const double rho = std::exp(-passed(series, i, ratios_.in_time) / ratios_.time_constant);
        state.col(0) *= rho;
        p.row(0) *= rho;
        p.col(0) *= rho;
        p(0, 0) += (1 - rho * rho) * ratios_.drift;
      }
      if (new_setup || series.pose[i] != series.pose[i - 1]) begin(state, p, 2, ratios_.pose);
      const double variance = 1 + p.sum();
      const Eigen::Vector3d gain = p.rowwise().sum() / variance;
      auto reading = readings.col(series.reading[i]);
      innovation = reading - state.rowwise().sum();
      state.noalias() += innovation * gain.transpose();
      p -= variance * gain * gain.transpose();
      reading = innovation / std::sqrt(variance);
      log_det += std::log(variance);
    }
    return log_det;
  }

  static void begin(Eigen::MatrixXd& state, Eigen::Matrix3d& p, Eigen::Index which, double variance) {
    state.col(which).setZero();
    p.row(which).setZero();
    p.col(which).setZero();
    p(which, which) = variance;
  }

  const NoiseLayout& layout_;
  const Ratios& ratios_;
};

Ratios ratios_of(const NoiseModel& model) {
  const double own = model.own * model.own;
  return {model.pose * model.pose / own, model.run * model.run / own, model.drift * model.drift / own,
          std::max(model.time_constant, 1e-300), model.in_time};
}

/// -2 log of the restricted likelihood as a function of the ratios, the own part at its best.
class Likelihood {
 public:
  Likelihood(const NoiseLayout& layout, const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted,
             bool own_from_u)
      : layout_(layout),
        own_from_u_(own_from_u),
        freedom_(static_cast<double>(residual.size() - fitted.cols())) {
    const auto n = static_cast<double>(residual.size()), k = static_cast<double>(fitted.cols());
    const bool whole = n * k * k < kMostNoiseProducts;
    const Eigen::Index columns = whole ? fitted.cols() : 0;
    readings_.resize(columns + 1, residual.size());
    if (columns > 0) readings_.topRows(columns) = fitted.transpose();
    readings_.row(columns) = residual.transpose();
  }

  double operator()(const Ratios& ratios, double* own = nullptr) const {
    Eigen::MatrixXd w = readings_;
    double value = Whitener(layout_, ratios).run(w);
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
    double variance = std::max(squares, 1e-300) / freedom_;
    if (own_from_u_) variance = std::max(variance, 1.0);
    if (own != nullptr) *own = std::sqrt(variance);
    return value + freedom_ * std::log(variance) + squares / variance;
  }

 private:
  const NoiseLayout& layout_;
  bool own_from_u_;  // it is not below 1
  double freedom_;
  Eigen::MatrixXd readings_;
};

/// Which of the components are in, and the logarithms of their ratios and of the time constant.
struct NoiseParts {
  bool pose = false, run = false, drift = false, in_time = false;
  std::array<double, 4> log = {0, 0, 0, 0};

  Ratios ratios() const {
    return {pose ? std::exp(log[0]) : 0, run ? std::exp(log[1]) : 0, drift ? std::exp(log[2]) : 0,
            std::exp(log[3]), in_time};
  }
};

/// Downhill along each coordinate in turn with shrinking steps: few parameters, a smooth valley.
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
          trial.log[i] += sign;
          trial.log[3] = std::clamp(trial.log[3], least_log_time, most_log_time);
          const double value = likelihood(trial.ratios());
          if (value > best - 1e-3) continue;
          best = value;
          parts = trial;
          moved = true;
          break;
        }
      }
    }
  return best;
}

/// A step of the instrument at one row, in the kinds of reading that it shows in.
struct StepsAtRow {
  std::vector<NoiseStep> steps;
  double net = 0;  // fall of the sum of squares beyond what the steps cost
};

/// What a step at each row of a series would take off the sum of squares, but for the first and last few rows
/// of a run.
std::vector<std::pair<NoiseStep, double>> steps_of(const NoiseSeries& series, const Eigen::VectorXd& residual,
                                                   const Eigen::MatrixXd& fitted) {
  constexpr std::size_t kLeastRows = 10;  // on either side of a step: fewer show none beside their own noise
  constexpr double kLeastOwn = 0.02;      // of a step's rows that the model cannot take over
  // A step where a run begins is a set-up, which machine files have a name for.
  std::vector<char> near_set_up(series.reading.size(), 0);
  for (std::size_t i = 1; i < series.reading.size(); ++i)
    if (series.setup[i] != series.setup[i - 1])
      for (std::size_t k = i - std::min(i, kLeastRows); k < std::min(i + kLeastRows, near_set_up.size()); ++k)
        near_set_up[k] = 1;
  std::vector<std::pair<NoiseStep, double>> list;
  double sum = 0, count = 0;
  Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(fitted.cols());
  for (std::size_t i = series.reading.size(); i-- > 0;) {
    sum += residual[series.reading[i]];
    along += fitted.row(series.reading[i]);
    ++count;
    if (i < kLeastRows || i + kLeastRows > series.reading.size() || near_set_up[i] != 0) continue;
    const double own = count - along.squaredNorm();
    if (own < kLeastOwn * count) continue;
    list.emplace_back(NoiseStep{series.kind, series.row[i], sum / own, 1 / std::sqrt(own)}, sum * sum / own);
  }
  return list;
}

/// The row at which a step lowers the sum of squares most beyond its price: who moves an instrument moves it
/// in all directions at once. `unit`: price of one number.
StepsAtRow best_steps(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                      const Eigen::MatrixXd& fitted, double unit) {
  std::map<std::size_t, StepsAtRow> of_row;
  for (const NoiseSeries& series : layout.series)
    for (const auto& [step, gain] : steps_of(series, residual, fitted)) {
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

/// A residual with its values held at 4 robust spreads: one wild reading is no property of the noise.
Eigen::VectorXd held(const Eigen::VectorXd& residual) {
  constexpr double kHeld = 4, kMadPerSpread = 1.4826;  // of a normal distribution
  std::vector<double> size(residual.data(), residual.data() + residual.size());
  for (double& value : size) value = std::abs(value);
  const double most = kHeld * kMadPerSpread * median(size);
  if (most <= 0) return residual;
  return residual.cwiseMax(-most).cwiseMin(most);
}

NoiseModel estimate_components(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                               const Eigen::MatrixXd& fitted, bool own_from_u) {
  NoiseModel model;
  model.in_time = layout.in_time;
  constexpr Eigen::Index kLeastFreedom =
      30;  // readings beyond the parameters: of fewer a variance is known to no better than a quarter
  if (residual.size() - fitted.cols() < kLeastFreedom || residual.squaredNorm() <= 0) return model;
  const Likelihood likelihood(layout, held(residual), fitted, own_from_u);
  const double least_log_time = std::log(layout.step), most_log_time = std::log(10 * layout.span);
  NoiseParts parts;
  parts.in_time = layout.in_time;
  const double white = likelihood(parts.ratios());
  double best = white;
  constexpr std::array<double, 5> kLogRatios = {-3, -1.5, 0, 1.5, 3};
  // One component after the other, the one that helps most first.
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
      offer(best_start(starts), kOneComponent);
    }
    if (!parts.run && layout.has_runs) {
      starts.clear();
      for (const double log : kLogRatios) {
        starts.push_back(parts);
        starts.back().run = true;
        starts.back().log[1] = log;
      }
      offer(best_start(starts), kOneComponent);
    }
    if (!parts.drift) {
      starts.clear();
      constexpr double kTimeSteps = 1.2;  // of the logarithm of a time constant: a factor of 3.3
      for (double time = least_log_time + kTimeSteps; time <= most_log_time; time += kTimeSteps)
        for (const double log : kLogRatios) {
          starts.push_back(parts);
          starts.back().drift = true;
          starts.back().log[2] = log;
          starts.back().log[3] = time;
        }
      if (!starts.empty()) offer(best_start(starts), kDriftComponent);
    }
    if (gain <= 0) break;
    parts = next;
    best = next_value;
  }
  if (parts.drift && layout.in_time) {
    // What goes from reading to reading, however long a move takes between them.
    NoiseParts by_rows = parts;
    by_rows.in_time = false;
    by_rows.log[3] = std::clamp(parts.log[3] - std::log(layout.step), 0.0, std::log(10 * layout.row_span));
    const double value =
        descend(likelihood, by_rows, likelihood(by_rows.ratios()), 0, std::log(10 * layout.row_span));
    if (value < best - kOneComponent) {
      parts = by_rows;
      best = value;
    }
  }
  model.in_time = parts.in_time;
  likelihood(parts.ratios(), &model.own);
  const Ratios ratios = parts.ratios();
  model.pose = model.own * std::sqrt(ratios.pose);
  model.run = model.own * std::sqrt(ratios.run);
  model.drift = model.own * std::sqrt(ratios.drift);
  model.time_constant = parts.drift ? ratios.time_constant : 0;
  model.support = white - best;
  model.log_likelihood = -best / 2;
  return model;
}

/// Independent readings of the size that is left.
NoiseModel white_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                       const Eigen::MatrixXd& fitted, bool own_from_u) {
  const Likelihood likelihood(layout, held(residual), fitted, own_from_u);
  NoiseModel model;
  model.in_time = layout.in_time;
  model.log_likelihood = -likelihood({}, &model.own) / 2;
  return model;
}

/// Nothing: next to nothing is a reading's own, what is left is what the model lacks. Where u is given it
/// states the whole of a reading, what it shares with others too; where the readings are far better than it
/// says, u counts as each reading's own.
std::optional<NoiseModel> estimate_beside(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                                          const Eigen::MatrixXd& fitted, bool with_u) {
  constexpr double kNearU = 0.7;  // of u: what readings far better than u scatter by is below it
  NoiseModel free = estimate_components(layout, residual, fitted, false);
  if (!with_u) return free.own < kLeastOwnPart * free.shared() ? std::nullopt : std::optional(free);
  if (free.log_likelihood == 0) return free;  // too few readings, or nothing left of them
  if (free.independent()) return white_noise(layout, residual, fitted, true);
  if (free.total() < kNearU) return estimate_components(layout, residual, fitted, true);
  const double scale = std::max(1.0, 1 / free.total());
  for (double* part : {&free.own, &free.pose, &free.run, &free.drift}) *part *= scale;
  return free;
}

}  // namespace

double NoiseModel::shared() const { return std::sqrt(pose * pose + run * run + drift * drift); }

double NoiseModel::price() const {
  double parameters = (pose > 0 ? 1 : 0) + (run > 0 ? 1 : 0) + (drift > 0 ? 2 : 0);
  std::set<std::size_t> places;  // of a set-up the row is told
  for (const NoiseStep& step : steps)
    parameters += step.of_set_up() || !places.insert(step.row).second ? 1 : 1 + kPriceOfPlace;
  return parameters;
}

double NoiseModel::total() const { return std::hypot(own, shared()); }

NoiseLayout noise_layout(const model::Measurement& measurement,
                         const std::vector<std::size_t>& observations) {
  NoiseLayout layout;
  const model::States& states = measurement.states;
  const std::vector<double> steps = relative_steps(measurement, model::commanded_states(measurement).axis);
  const double tolerance = pose_tolerance(steps);
  std::vector<int> pose(measurement.rows(), 0);
  for (std::size_t row = 1; row < pose.size(); ++row)
    pose[row] = pose[row - 1] + (steps[row] > tolerance ? 1 : 0);
  // Time counts where it is told and never runs back within a clock.
  bool moves = false, falls = false;
  for (std::size_t row = 1; row < measurement.rows(); ++row) {
    if (states.of(states.clock, row) != states.of(states.clock, row - 1)) continue;
    const auto at = static_cast<Eigen::Index>(row);
    moves = moves || states.time[at] > states.time[at - 1];
    falls = falls || states.time[at] < states.time[at - 1];
  }
  layout.in_time = moves && !falls;
  std::map<int, NoiseSeries> of_kind;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const model::Observation& o = measurement.observations[observations[i]];
    NoiseSeries& series = of_kind[static_cast<int>(o.kind)];
    series.reading.push_back(static_cast<Eigen::Index>(i));
    series.kind = static_cast<int>(o.kind);
    series.row.push_back(o.row);
    series.time.push_back(layout.in_time ? states.time[static_cast<Eigen::Index>(o.row)]
                                         : static_cast<double>(o.row));
    series.setup.push_back(static_cast<int>(states.of(states.setup, o.row)));
    series.clock.push_back(static_cast<int>(states.of(states.clock, o.row)));
    series.pose.push_back(pose[o.row]);
    if (o.kind == model::ObservationKind::kD) {
      const auto at = static_cast<Eigen::Index>(o.row);
      series.normal.emplace_back(states.normal[0][at], states.normal[1][at], states.normal[2][at]);
    }
  }
  std::vector<double> gaps;
  for (auto& [kind, series] : of_kind) {
    double begun = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < series.reading.size(); ++i) {
      layout.has_runs = layout.has_runs || (i > 0 && series.setup[i] != series.setup[i - 1]);
      if (i == 0 || series.clock[i] != series.clock[i - 1]) {
        begun = series.time[i];
        first = series.row[i];
        continue;
      }
      layout.has_poses = layout.has_poses || series.pose[i] == series.pose[i - 1];
      gaps.push_back(series.time[i] - series.time[i - 1]);
      layout.span = std::max(layout.span, series.time[i] - begun);
      layout.row_span = std::max(layout.row_span, static_cast<double>(series.row[i] - first));
    }
    layout.series.push_back(std::move(series));
  }
  if (!gaps.empty()) layout.step = median(gaps);
  if (!(layout.step > 0)) layout.step = layout.span / std::max<double>(1, static_cast<double>(gaps.size()));
  return layout;
}

Eigen::MatrixXd step_columns(const NoiseLayout& layout, const std::vector<NoiseStep>& steps,
                             Eigen::Index readings) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(readings, static_cast<Eigen::Index>(steps.size()));
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (const NoiseSeries& series : layout.series) {
      if (series.kind != steps[k].kind) continue;
      for (std::size_t i = 0; i < series.reading.size(); ++i)
        if (series.row[i] >= steps[k].row)
          columns(series.reading[i], static_cast<Eigen::Index>(k)) =
              steps[k].of_set_up() ? series.normal[i][steps[k].component] : 1;
    }
  return columns;
}

std::vector<NoiseStep> set_up_steps(const NoiseLayout& layout) {
  std::vector<NoiseStep> steps;
  for (const NoiseSeries& series : layout.series) {
    if (series.kind != static_cast<int>(model::ObservationKind::kD)) continue;
    for (std::size_t i = 0; i < series.reading.size(); ++i)
      if (i == 0 || series.setup[i] != series.setup[i - 1])
        for (int component = 0; component < 3; ++component)
          steps.push_back({series.kind, series.row[i], 0, 0, component});
  }
  constexpr std::size_t kOneSetUp = 3;  // components of a single set-up, which no other is told from
  return steps.size() > kOneSetUp ? steps : std::vector<NoiseStep>();
}

double whiten(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns) {
  const double own = 2 * std::log(model.own) * static_cast<double>(columns.rows());
  if (model.independent()) {
    columns /= model.own;
    return own;
  }
  Eigen::MatrixXd readings = columns.transpose();
  const Ratios ratios = ratios_of(model);
  const double log_det = Whitener(layout, ratios).run(readings);
  columns = readings.transpose() / model.own;
  return own + log_det;
}

Eigen::MatrixXd covariance_times(const NoiseLayout& layout, const NoiseModel& model,
                                 const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd x = columns.transpose();
  Eigen::MatrixXd y = model.own * model.own * x;
  for (const NoiseSeries& series : layout.series) {
    const std::size_t n = series.reading.size();
    // Sums over stretches of one set-up and one pose, each given back to all its readings.
    const auto share = [&](double variance, const std::function<bool(std::size_t)>& begins) {
      if (variance <= 0) return;
      for (std::size_t first = 0; first < n;) {
        std::size_t last = first + 1;
        while (last < n && !begins(last)) ++last;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
        for (std::size_t i = first; i < last; ++i) sum += x.col(series.reading[i]);
        for (std::size_t i = first; i < last; ++i) y.col(series.reading[i]) += variance * sum;
        first = last;
      }
    };
    const auto new_setup = [&](std::size_t i) { return series.setup[i] != series.setup[i - 1]; };
    const auto new_clock = [&](std::size_t i) { return series.clock[i] != series.clock[i - 1]; };
    share(model.run * model.run, new_setup);
    share(model.pose * model.pose,
          [&](std::size_t i) { return new_setup(i) || series.pose[i] != series.pose[i - 1]; });
    if (model.drift <= 0) continue;
    // exp(-|t - t'| / tau): what came before, then what comes after, each by one recursion.
    const auto rho = [&](std::size_t i) {
      return new_clock(i) ? 0 : std::exp(-passed(series, i, model.in_time) / model.time_constant);
    };
    const double variance = model.drift * model.drift;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) sum *= rho(i);
      sum += x.col(series.reading[i]);
      y.col(series.reading[i]) += variance * sum;
    }
    sum.setZero();
    for (std::size_t i = n; i-- > 0;) {
      y.col(series.reading[i]) += variance * sum;
      sum += x.col(series.reading[i]);
      if (i > 0) sum *= rho(i);
    }
  }
  return y.transpose();
}

NoiseModel estimate_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& fitted, bool with_u) {
  const std::optional<NoiseModel> alone = estimate_beside(layout, residual, fitted, with_u);
  if (!alone) return white_noise(layout, residual, fitted, false);
  const NoiseModel& without = *alone;
  // Steps of the instrument, one after the other, each of which explains more than chance at so many places;
  // they stand only where the whole is better than a drift without them.
  constexpr std::size_t kMostPlaces = 4;
  const auto n = static_cast<double>(residual.size());
  std::vector<NoiseStep> steps;
  Eigen::VectorXd left = residual;
  Eigen::MatrixXd all = fitted;
  for (std::size_t place = 0; place < kMostPlaces; ++place) {
    const double variance = left.squaredNorm() / std::max(1.0, n - static_cast<double>(all.cols()));
    const StepsAtRow best = best_steps(layout, left, all, std::log(n) * std::max(variance, 1e-300));
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
  std::optional<NoiseModel> beside = estimate_beside(layout, left, all, with_u);
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

std::string in_words(const NoiseModel& model, double unit_um) {
  std::string text = fmt::format("each reading {:.3g} um", model.own * unit_um);
  if (model.pose > 0)
    text += fmt::format(", shared by the readings of a pose {:.3g} um", model.pose * unit_um);
  if (model.run > 0) text += fmt::format(", by a run {:.3g} um", model.run * unit_um);
  if (model.drift > 0)
    text += fmt::format(", a drift of {:.3g} um that lasts {:.3g} {}", model.drift * unit_um,
                        model.time_constant, model.in_time ? "s" : "rows");
  double set_ups = 0, count = 0;
  for (const NoiseStep& step : model.steps) {
    if (!step.of_set_up()) continue;
    set_ups += step.height * step.height;
    count += 1.0 / 3;
  }
  if (count > 0)
    text += fmt::format(", what is touched shifts by {:.3g} um from set-up to set-up",
                        std::sqrt(set_ups / count) * unit_um);
  for (const NoiseStep& step : model.steps)
    if (!step.of_set_up())
      text += fmt::format(", a step of {:.3g} +- {:.2g} um in {} from row {} on", step.height * unit_um,
                          step.std * unit_um, model::kObservationNames[static_cast<std::size_t>(step.kind)],
                          step.row + 1);
  return text;
}

}  // namespace vernier::fit
