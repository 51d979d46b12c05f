// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/noise_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "tools/maths/factors.h"
#include "tools/maths/median.h"

namespace vernier::fit {
namespace {

/// Returns the largest share of its range that any axis moves from one row to the next.
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

/// Returns the tolerance below which a step is zero. It is at the widest gap in the sizes of
/// steps, with a factor above `gap` and at least a given number of steps below it. 0 if there is
/// no such gap. Steps below `least` count as `least`.
double tolerance_of(const std::vector<double>& steps, double gap_asked, double least, std::size_t below,
                    const LayoutThresholds& limits) {
  std::vector<double> sorted = steps;
  for (double& step : sorted) step = std::max(step, least);
  std::sort(sorted.begin(), sorted.end());
  double widest = gap_asked, tolerance = 0;
  for (std::size_t i = std::max<std::size_t>(1, below); i < sorted.size(); ++i) {
    if (sorted[i - 1] > limits.small_step) break;
    const double gap = sorted[i] / sorted[i - 1];
    if (gap <= widest) continue;
    widest = gap;
    tolerance = std::sqrt(sorted[i] * sorted[i - 1]);
  }
  return tolerance;
}

/// Returns for each row the number of its group of equal values on one axis.
std::vector<int> groups_along(const model::Column& axis, const LayoutThresholds& limits) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(axis.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return axis[a] < axis[b]; });
  std::vector<double> steps;
  double least = 1;  // digits: a step of zero counts as one of the last digit
  const double range = order.empty() ? 1 : std::max(axis[order.back()] - axis[order.front()], 1e-12);
  for (std::size_t i = 1; i < order.size(); ++i) {
    steps.push_back((axis[order[i]] - axis[order[i - 1]]) / range);
    if (steps.back() > kNoStep) least = std::min(least, steps.back());
  }
  const auto below = static_cast<std::size_t>(limits.least_revisits * static_cast<double>(steps.size()));
  const double tolerance = std::max(tolerance_of(steps, limits.revisit_gap, least, below, limits), kNoStep);
  std::vector<int> group(order.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    group[static_cast<std::size_t>(order[i])] =
        group[static_cast<std::size_t>(order[i - 1])] + (steps[i - 1] > tolerance ? 1 : 0);
  return group;
}

/// True if the times of the file continue from each run to the next: the same clock recorded all runs, and a
/// drift of the instrument continues too. A column `clock` states the opposite.
bool time_continues(const model::States& states, std::size_t rows) {
  if (!states.clock.of.empty()) return false;
  for (std::size_t row = 1; row < rows; ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    if (states.run[row] != states.run[row - 1] && !(states.time[at] > states.time[at - 1])) return false;
  }
  return true;
}

}  // namespace

std::vector<int> places_of_rows(const model::Measurement& measurement, const LayoutThresholds& limits) {
  std::vector<std::vector<int>> key(measurement.rows());
  for (const model::Column& axis : model::commanded_states(measurement).axis) {
    const std::vector<int> group = groups_along(axis, limits);
    for (std::size_t row = 0; row < key.size(); ++row) key[row].push_back(group[row]);
  }
  std::map<std::vector<int>, int> number;
  std::vector<int> places;
  for (const std::vector<int>& one : key)
    places.push_back(number.try_emplace(one, static_cast<int>(number.size())).first->second);
  return places;
}

double passed(const NoiseSeries& series, std::size_t i, bool in_time) {
  return in_time ? series.time[i] - series.time[i - 1]
                 : static_cast<double>(series.row[i]) - static_cast<double>(series.row[i - 1]);
}

NoiseLayout noise_layout(const model::Measurement& measurement, const std::vector<std::size_t>& observations,
                         const LayoutThresholds& limits) {
  NoiseLayout layout;
  const model::States& states = measurement.states;
  const std::vector<double> steps = relative_steps(measurement, model::commanded_states(measurement).axis);
  const double tolerance = tolerance_of(steps, limits.pose_gap, kNoStep, 1, limits);
  std::vector<int> pose(measurement.rows(), 0);
  for (std::size_t row = 1; row < pose.size(); ++row)
    pose[row] = pose[row - 1] + (steps[row] > tolerance ? 1 : 0);
  // Time is used if it is recorded and never decreases within a clock. A clock that stands still over its
  // rows is that of a file without times.
  bool moves = false, falls = false;
  std::map<std::size_t, std::pair<double, double>> ends;  // of each clock: smallest and largest time
  std::map<std::size_t, std::size_t> count;
  for (std::size_t row = 0; row < measurement.rows(); ++row) {
    const double time = states.time[static_cast<Eigen::Index>(row)];
    const auto [end, fresh] = ends.try_emplace(states.of(states.clock, row), time, time);
    end->second = {std::min(end->second.first, time), std::max(end->second.second, time)};
    ++count[states.of(states.clock, row)];
  }
  const bool stands = std::any_of(ends.begin(), ends.end(), [&](const auto& one) {
    return count[one.first] > 1 && one.second.first == 0 && one.second.second == 0;
  });
  for (std::size_t row = 1; row < measurement.rows(); ++row) {
    if (states.of(states.clock, row) != states.of(states.clock, row - 1)) continue;
    const auto at = static_cast<Eigen::Index>(row);
    moves = moves || states.time[at] > states.time[at - 1];
    falls = falls || states.time[at] < states.time[at - 1];
  }
  layout.in_time = moves && !falls && !stands;
  const bool one_clock = layout.in_time && time_continues(states, measurement.rows());
  std::map<int, NoiseSeries> of_kind;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const model::Observation& o = measurement.observations[observations[i]];
    NoiseSeries& series = of_kind[static_cast<int>(o.kind)];
    series.reading.push_back(static_cast<Eigen::Index>(i));
    series.kind = static_cast<int>(o.kind);
    series.row.push_back(o.row);
    const double u = model::uncertainty_of(measurement, o);
    series.unit.push_back((u > 0 ? u : 1) *
                          (model::is_rotation(o.kind) ? maths::kArcsecPerDeg : maths::kUmPerMm));
    series.time.push_back(layout.in_time ? states.time[static_cast<Eigen::Index>(o.row)]
                                         : static_cast<double>(o.row));
    series.setup.push_back(static_cast<int>(states.of(states.setup, o.row)));
    series.clock.push_back(one_clock ? 0 : static_cast<int>(states.of(states.clock, o.row)));
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
  if (!gaps.empty()) layout.step = maths::median(gaps);
  if (!(layout.step > 0)) layout.step = layout.span / std::max<double>(1, static_cast<double>(gaps.size()));
  return layout;
}

}  // namespace vernier::fit
