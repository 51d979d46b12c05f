// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/motion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/format/columns.h"
#include "tools/simulate/path.h"
#include "tools/text/error.h"

namespace vernier::simulate {
namespace {

/// Smaller motion is the last digit of a path file, not motion; mm or deg.
constexpr double kRest = 1e-9;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

model::Column interpolate(const model::Column& rows, const Ticks& ticks) {
  model::Column result(index(ticks.count()));
  for (std::size_t k = 0; k < ticks.count(); ++k) {
    const Eigen::Index near = index(ticks.segment[k]), far = std::min(near + 1, rows.size() - 1);
    result[index(k)] = rows[near] + ticks.fraction[index(k)] * (rows[far] - rows[near]);
  }
  return result;
}

/// The value of the row at or before the tick.
model::Column hold(const model::Column& rows, const Ticks& ticks) {
  model::Column result(index(ticks.count()));
  for (std::size_t k = 0; k < ticks.count(); ++k) {
    const bool last = ticks.fraction[index(k)] >= 1 && index(ticks.segment[k]) + 1 < rows.size();
    result[index(k)] = rows[index(ticks.segment[k]) + (last ? 1 : 0)];
  }
  return result;
}

/// Motion of an axis as derived from its positions along the rows. One entry per segment, `turn`
/// the position of the last reversal (NaN: none yet).
struct Segments {
  model::Column speed, sense, turn;
  model::Column acceleration;  // one per row
};

Segments segments_of(const model::Column& time, const model::Column& position) {
  const Eigen::Index count = std::max<Eigen::Index>(1, time.size() - 1);
  Segments s{model::Column::Zero(count), model::Column::Zero(count),
             model::Column::Constant(count, std::nan("")), model::Column::Zero(time.size())};
  double sense = 0, turn = std::nan("");
  for (Eigen::Index i = 0; i + 1 < time.size(); ++i) {
    const double travel = position[i + 1] - position[i];
    s.speed[i] = std::abs(travel) > kRest ? travel / (time[i + 1] - time[i]) : 0;
    const double now = s.speed[i] > 0 ? 1 : s.speed[i] < 0 ? -1 : sense;
    if (sense != 0 && now != sense) turn = position[i];
    sense = now;
    s.sense[i] = sense;
    s.turn[i] = turn;
  }
  for (Eigen::Index i = 1; i + 1 < time.size(); ++i)
    s.acceleration[i] = 2 * (s.speed[i] - s.speed[i - 1]) / (time[i + 1] - time[i - 1]);
  if (time.size() > 2) {
    s.acceleration[0] = s.acceleration[1];
    s.acceleration[time.size() - 1] = s.acceleration[time.size() - 2];
  }
  return s;
}

model::Column of_segment(const model::Column& values, const Ticks& ticks) {
  model::Column result(index(ticks.count()));
  for (std::size_t k = 0; k < ticks.count(); ++k) result[index(k)] = values[index(ticks.segment[k])];
  return result;
}

void fill_axis(const Path& path, const model::Axis& axis, const Ticks& ticks, std::size_t i,
               model::States& states) {
  if (!path.has(axis.name))
    throw text::InputError({path.file(), 0}, axis.name, "the path file has no column for this axis");
  using format::AxisQuantity;
  const auto name = [&](AxisQuantity quantity) { return format::axis_column(quantity, axis.name); };
  const auto numbers = [&](AxisQuantity quantity) {
    return path.numbers(name(quantity), format::dimension_of(quantity, axis.rotary));
  };
  const auto has = [&](AxisQuantity quantity) { return path.has(name(quantity)); };
  const model::Column rows = numbers(AxisQuantity::kPosition);
  const Segments s = segments_of(path.time(), rows);
  states.axis[i] = interpolate(rows, ticks);
  states.velocity[i] = has(AxisQuantity::kSpeed) ? interpolate(numbers(AxisQuantity::kSpeed), ticks)
                                                 : of_segment(s.speed, ticks);
  states.acceleration[i] = interpolate(
      has(AxisQuantity::kAcceleration) ? numbers(AxisQuantity::kAcceleration) : s.acceleration, ticks);
  states.direction[i] =
      has(AxisQuantity::kSense) ? hold(numbers(AxisQuantity::kSense), ticks) : of_segment(s.sense, ticks);
  if (((states.direction[i] != 0) && (states.direction[i].abs() != 1)).any())
    throw text::InputError({path.file(), 0}, name(AxisQuantity::kSense), "a direction is -1, 0 or 1");
  if (has(AxisQuantity::kSince)) {
    states.since[i] = interpolate(numbers(AxisQuantity::kSince), ticks);
  } else {
    const model::Column turn = of_segment(s.turn, ticks);
    states.since[i] = turn.isNaN().select(model::kLongWay, (states.axis[i] - turn).abs());
  }
}

/// feed in mm/min, curvature in 1/mm, over the linear axes.
void fill_path(const Path& path, const model::Machine& machine, const Ticks& ticks, model::States& states) {
  const model::Column zero = model::Column::Zero(index(ticks.count()));
  model::Column vv = zero, aa = zero, va = zero;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].rotary) continue;
    vv += states.velocity[i].square();
    aa += states.acceleration[i].square();
    va += states.velocity[i] * states.acceleration[i];
  }
  states.feed =
      path.has(format::columns::kFeed)
          ? model::Column(60 *
                          interpolate(path.numbers(format::columns::kFeed, format::Dimension::kSpeed), ticks))
          : model::Column(60 * vv.sqrt());
  // |v x a|^2 = |v|^2 |a|^2 - (v.a)^2, in any number of dimensions. At rest a path has no curvature.
  const model::Column bend = (vv * aa - va.square()).max(0).sqrt() / (vv * vv.sqrt()).max(1e-300);
  states.curvature =
      path.has(format::columns::kCurvature)
          ? interpolate(path.numbers(format::columns::kCurvature, format::Dimension::kCurvature), ticks)
          : model::Column((vv > 1e-12).select(bend, 0));
}

void fill_runs(const Path& path, const Ticks& ticks, model::States& states) {
  if (!path.has(format::columns::kRun)) return;
  const std::vector<std::string> labels = path.words(format::columns::kRun);
  std::map<std::string, std::size_t> known;
  states.run_names.clear();
  for (std::size_t k = 0; k < ticks.count(); ++k) {
    const std::string& label = labels[ticks.segment[k]];
    const auto [found, fresh] = known.emplace(label, states.run_names.size());
    if (fresh) states.run_names.push_back(label);
    states.run[k] = found->second;
  }
}

}  // namespace

model::States path_states(const Path& path, const model::Machine& machine, const Ticks& ticks) {
  model::States states = model::make_states(ticks.count(), machine);
  states.time = ticks.time;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) fill_axis(path, machine.axes[i], ticks, i, states);
  fill_path(path, machine, ticks, states);
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    if (path.has(machine.inputs[i].name)) states.input[i] = interpolate(path.input(machine.inputs[i]), ticks);
  for (std::size_t i = 0; i < 3; ++i)
    if (const std::string name = std::string("n") + "xyz"[i]; path.has(name))
      states.normal[i] = interpolate(path.numbers(name, format::Dimension::kNone), ticks);
  if (path.has(format::columns::kVisit))
    states.visit = hold(path.numbers(format::columns::kVisit, format::Dimension::kNone), ticks);
  fill_runs(path, ticks, states);
  return states;
}

}  // namespace vernier::simulate
