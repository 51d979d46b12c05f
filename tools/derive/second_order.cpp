// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/second_order.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/compile/derive.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/derive/numeric.h"
#include "tools/model/chain/chain.h"

namespace vernier::derive {
namespace {

using GiNaC::ex;

compile::Interval scaled(const compile::Interval& a, double by) { return {a.low / by, a.high / by}; }

/// A motion over the ranges: its range, and its speed and acceleration when all errors grow from
/// 0.
struct Travel {
  compile::Interval value;
  double speed = 0, acceleration = 0;
};

Travel travel_of(const ErrorEquation& equation, const ElementaryMotion& motion, const Ranges& ranges) {
  Travel travel;
  travel.value = range_of(motion.value, ranges);
  std::vector<std::pair<ex, double>> slopes;
  for (const ErrorParameter& p : equation.parameters) {
    if (!motion.value.has(p.symbol)) continue;
    slopes.emplace_back(motion.value.diff(p.symbol), p.magnitude);
    travel.speed += p.magnitude * range_of(slopes.back().first, ranges).magnitude();
  }
  for (const auto& [slope, size] : slopes)
    for (const ErrorParameter& p : equation.parameters)
      if (slope.has(p.symbol))
        travel.acceleration += size * p.magnitude * range_of(slope.diff(p.symbol), ranges).magnitude();
  return travel;
}

/// Box of a vector and a bound of its norm.
struct TermReach {
  std::array<compile::Interval, 3> box{};
  double norm = 0;

  void clip() {
    double sum = 0;
    for (compile::Interval& b : box) {
      b = {std::max(b.low, -norm), std::min(b.high, norm)};
      sum += b.magnitude() * b.magnitude();
    }
    norm = std::min(norm, std::sqrt(sum) * (1 + 1e-12));
  }
  void shift(std::size_t axis, const compile::Interval& by) {
    box[axis] = box[axis] + by;
    norm += by.magnitude();
    clip();
  }
  void turn(std::size_t axis, const compile::Interval& angle_rad) {
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    const compile::Interval c = cosine_range(angle_rad), s = sine_range(angle_rad), a = box[i], b = box[j];
    box[i] = c * a + -1.0 * (s * b);
    box[j] = s * a + c * b;
    clip();
  }
  double from_axis(std::size_t axis) const {
    return std::min(norm, std::hypot(box[(axis + 1) % 3].magnitude(), box[(axis + 2) % 3].magnitude()));
  }
};

compile::Interval opaque_range(const OpaqueSymbol& o, const Ranges& ranges) {
  const auto arg = [&](std::size_t i) { return range_of(o.args[i], ranges); };
  switch (o.expr->op) {
    case model::Op::kSign:
      return {-1, 1};
    case model::Op::kAbs:
      return {0, arg(0).magnitude()};
    case model::Op::kMin:
    case model::Op::kMax:
      return compile::hull(arg(0), arg(1));
    case model::Op::kLag:
      return arg(0);
    default:
      return {0, 1};
  }
}

std::optional<compile::Interval> axis_symbol_range(const model::Machine& machine, std::size_t index) {
  const model::Axis& axis = machine.axes[index];
  if (axis.min && axis.max) return compile::Interval{*axis.min, *axis.max};
  if (const model::Table* table = machine.table_of(index); table != nullptr && !table->stations.empty())
    return compile::Interval{table->stations.front().loc, table->stations.back().loc};
  if (axis.rotary) return compile::Interval{-180, 180};
  return std::nullopt;
}

std::optional<compile::Interval> nominal_range(const model::Machine& machine, const model::Symbol& key) {
  const std::size_t i = key.index;
  switch (key.kind) {
    case model::SymbolKind::kStatic: {
      const double value = machine.statics[i].nominal.value_or(machine.statics[i].value);
      return compile::Interval{value, value};
    }
    case model::SymbolKind::kAxis:
      return axis_symbol_range(machine, i);
    case model::SymbolKind::kInput:
      return compile::input_range(machine, i);
    case model::SymbolKind::kVelocity:
      return compile::channel_range(machine, ChannelKind::kVelocity, i);
    case model::SymbolKind::kAcceleration:
      return compile::channel_range(machine, ChannelKind::kAcceleration, i);
    case model::SymbolKind::kDirection:
    case model::SymbolKind::kNormal:
      return compile::Interval{-1, 1};
    case model::SymbolKind::kSince:
      return compile::Interval{0, model::kLongWay};
    case model::SymbolKind::kFeed:
      return compile::channel_range(machine, ChannelKind::kFeed, i);
    case model::SymbolKind::kCurvature:
      return compile::channel_range(machine, ChannelKind::kCurvature, i);
    case model::SymbolKind::kTime:
      return compile::channel_range(machine, ChannelKind::kTime, i);
    case model::SymbolKind::kVisit:
      return compile::channel_range(machine, ChannelKind::kVisit, i);
    default:
      return std::nullopt;
  }
}

Ranges all_ranges(const ErrorEquation& equation) {
  Ranges ranges = nominal_ranges(equation);
  for (const ErrorParameter& p : equation.parameters) ranges[p.symbol] = {-p.magnitude, p.magnitude};
  for (const OpaqueSymbol& o : equation.opaque) ranges[o.symbol] = opaque_range(o, ranges);
  return ranges;
}

SecondOrder bound_of(const ErrorEquation& equation, const Ranges& ranges) {
  std::vector<Travel> travels;
  std::vector<double> levers(equation.motions.size());
  for (const ElementaryMotion& m : equation.motions) travels.push_back(travel_of(equation, m, ranges));
  TermReach tip;
  for (std::size_t j = equation.motions.size(); j-- > 0;) {
    const ElementaryMotion& m = equation.motions[j];
    const auto axis = static_cast<std::size_t>(m.axis);
    levers[j] = m.rotation ? tip.from_axis(axis) : 1;
    if (m.rotation)
      tip.turn(axis, travels[j].value);
    else
      tip.shift(axis, travels[j].value);
  }
  double position = 0, direction = 0, turning_below = 0;
  for (std::size_t j = 0; j < equation.motions.size(); ++j) {
    const auto& [value, speed, acceleration] = travels[j];
    const bool turns = equation.motions[j].rotation;
    position += levers[j] * (acceleration + (turns ? speed * speed : 0) + 2 * turning_below * speed);
    if (!turns) continue;
    turning_below += speed;
    direction += acceleration;
  }
  direction += turning_below * turning_below;
  return {position / 2 * (1 + 1e-9), direction / 2 * (1 + 1e-9)};
}

}  // namespace

Ranges nominal_ranges(const ErrorEquation& equation) {
  Ranges ranges;
  for (const NominalSymbol& n : equation.nominal)
    if (const auto range = nominal_range(equation.machine, n.key))
      ranges[n.symbol] = scaled(*range, n.file_units);
  return ranges;
}

SecondOrderBound bound_second_order(const ErrorEquation& equation) {
  try {
    return {bound_of(equation, all_ranges(equation)), ""};
  } catch (const NoRange& none) {
    return {std::nullopt, none.what()};
  }
}

std::optional<SecondOrder> sample_second_order(const ErrorEquation& equation, std::size_t count,
                                               std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const model::Machine nominal = model::nominal_machine(equation.machine);
  SecondOrder largest;
  for (std::size_t i = 0; i < count; ++i) {
    model::States states = model::make_states(1, nominal);
    for (std::size_t a = 0; a < nominal.axes.size(); ++a) {
      const auto range = axis_symbol_range(nominal, a);
      if (!range) return std::nullopt;
      states.axis[a][0] = std::uniform_real_distribution<double>(range->low, range->high)(random);
    }
    Eigen::VectorXd errors(static_cast<Eigen::Index>(equation.parameters.size()));
    for (Eigen::Index p = 0; p < errors.size(); ++p)
      errors[p] = (random() % 2 == 0 ? 1 : -1) * equation.parameters[static_cast<std::size_t>(p)].magnitude;
    const model::Poses ideal = model::forward(nominal, states),
                       real = model::forward(with_errors(equation, errors), states);
    const Eigen::VectorXd linear = sensitivity_at(equation, states, 0) * errors;
    const Eigen::Vector3d axis = ideal.rotation[0].col(2), turn = linear.tail<3>();
    const double missing = (real.position - ideal.position - linear.head<3>()).norm();
    const double missing_axis = (real.rotation[0].col(2) - axis - turn.cross(axis)).norm();
    largest.position_mm = std::max(largest.position_mm, missing);
    largest.axis_rad = std::max(largest.axis_rad, missing_axis);
  }
  return largest;
}

}  // namespace vernier::derive
