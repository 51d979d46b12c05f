// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/dual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/model/station_table.h"

namespace vernier::compile {
namespace {

// Returns an interval that contains the spline, not only its stations. A cubic piece is within its
// Bezier control values.
Interval column_range(const model::Table& table, std::size_t column) {
  const model::StationTable look_up(table);
  Interval range{table.stations[0].value[column], table.stations[0].value[column]};
  for (std::size_t i = 0; i < table.stations.size(); ++i) {
    const double value = table.stations[i].value[column];
    range = hull(range, {value, value});
    if (table.interpolation == model::Interpolation::kLinear || i + 1 == table.stations.size()) continue;
    const double width = table.stations[i + 1].loc - table.stations[i].loc;
    const double next = table.stations[i + 1].value[column];
    const double inside = 1e-9 * width;  // slopes are zero beyond the ends, the piece's own just inside
    const double near = value + look_up.slopes(table.stations[i].loc + inside)[column] * width / 3;
    const double far = next - look_up.slopes(table.stations[i + 1].loc - inside)[column] * width / 3;
    const double slack = 1e-6 * (std::abs(near - value) + std::abs(far - next));
    range = hull(range, {std::min(near, far) - slack, std::max(near, far) + slack});
  }
  return range;
}

// Returns the steepest slope of a column. A cubic piece's slope is within the control values of
// its derivative.
double column_slope(const model::Table& table, std::size_t column) {
  const model::StationTable look_up(table);
  double steepest = 0;
  for (std::size_t i = 0; i + 1 < table.stations.size(); ++i) {
    const double loc = table.stations[i].loc, width = table.stations[i + 1].loc - loc;
    const double mean = (table.stations[i + 1].value[column] - table.stations[i].value[column]) / width;
    steepest = std::max(steepest, std::abs(mean));
    if (table.interpolation == model::Interpolation::kLinear) continue;
    const double near = look_up.slopes(loc + 1e-9 * width)[column],
                 far = look_up.slopes(loc + width - 1e-9 * width)[column];
    steepest = std::max({steepest, std::abs(near), std::abs(far), std::abs(3 * mean - near - far)});
  }
  return steepest * (1 + 1e-6);
}

}  // namespace

NodeId Translator::channel(ChannelKind kind, std::size_t index) {
  return g_.channel(kind, static_cast<std::uint32_t>(index), channel_range(machine_, kind, index));
}

NodeId Translator::table_value(std::size_t index) {
  const std::size_t axis = index / 6, column = index % 6;
  const model::Table* const table = machine_.table_of(axis);
  if (table == nullptr) return g_.constant(0);
  const Interval range = column_range(*table, column);
  if (range.low == range.high) return g_.constant(range.low);
  const auto added = added_.find(axis);
  NodeId position = channel(ChannelKind::kPosition, axis);
  if (added != added_.end()) position = g_.add(position, added->second);
  const NodeId value =
      g_.table(static_cast<std::uint32_t>(axis), static_cast<std::uint32_t>(column), position, range);
  d_.table_slopes[value] = column_slope(*table, column);
  return value;
}

Dual Translator::symbol(const model::Expr& expr) {
  const NodeId zero = g_.constant(0);
  const std::size_t i = expr.symbol.index;
  switch (expr.symbol.kind) {
    case model::SymbolKind::kStatic: {
      const model::Static& s = machine_.statics[i];
      const double nominal = s.nominal.value_or(s.value);
      return constant(nominal, s.value - nominal);
    }
    case model::SymbolKind::kAxis: {
      const NodeId raw = channel(ChannelKind::kPosition, i);
      const double factor = machine_.axes[i].scale_factor;
      const auto added = added_.find(i);
      if (added == added_.end()) return {raw, g_.scale(factor, raw)};
      return {raw, g_.sum(0, {{factor, raw}, {1 + factor, added->second}})};
    }
    case model::SymbolKind::kTableValue:
      return {zero, table_value(i)};
    case model::SymbolKind::kInput:
      return {channel(ChannelKind::kInput, i), zero};
    case model::SymbolKind::kVelocity:
      return {channel(ChannelKind::kVelocity, i), zero};
    case model::SymbolKind::kAcceleration:
      return {channel(ChannelKind::kAcceleration, i), zero};
    case model::SymbolKind::kDirection:
      return {channel(ChannelKind::kSense, i), zero};
    case model::SymbolKind::kSince:
      return {channel(ChannelKind::kSince, i), zero};
    case model::SymbolKind::kFeed:
      return {channel(ChannelKind::kFeed, 0), zero};
    case model::SymbolKind::kCurvature:
      return {channel(ChannelKind::kCurvature, 0), zero};
    case model::SymbolKind::kTime:
      return {channel(ChannelKind::kTime, 0), zero};
    case model::SymbolKind::kVisit:
      return {channel(ChannelKind::kVisit, 0), zero};
    case model::SymbolKind::kNormal:
      note("nx, ny and nz are columns of a measurement; in an image they are 0");
      return {zero, zero};
    case model::SymbolKind::kUnresolved:
      break;
  }
  throw std::domain_error("the name \"" + expr.name + "\", which is not resolved");
}

void Translator::note(const std::string& text) {
  if (std::find(d_.notes.begin(), d_.notes.end(), text) == d_.notes.end()) d_.notes.push_back(text);
}

void Translator::note_step(const std::string& text) {
  if (std::find(d_.switching.begin(), d_.switching.end(), text) == d_.switching.end())
    d_.switching.push_back(text);
}

namespace {

// The terms of a sum of sums.
void expand(const Graph& g, double k, NodeId id, double& number, std::map<NodeId, double>& terms,
            std::map<NodeId, double>& sizes) {
  const Node& node = g[id];
  if (node.kind != NodeKind::kSum) {
    terms[id] += k;
    sizes[id] += std::abs(k);
    return;
  }
  number += k * node.number;
  for (const Term& term : node.terms) expand(g, k * term.coefficient, term.node, number, terms, sizes);
}

}  // namespace

// A function of an axis with an addition is not computed as its nominal value plus a difference,
// because their intervals are independent. If the two cancel, the remainder is used.
NodeId Translator::actual(const Dual& a) {
  if (added_.empty() || g_.is_zero(a.delta)) return g_.add(a.nominal, a.delta);
  constexpr double kRounding = 1e-12;  // of a coefficient: a smaller remainder is zero
  double number = 0;
  std::map<NodeId, double> terms, sizes;
  expand(g_, 1, a.nominal, number, terms, sizes);
  expand(g_, 1, a.delta, number, terms, sizes);
  std::vector<Term> left;
  for (const auto& [node, k] : terms)
    if (std::abs(k) > kRounding * sizes[node]) left.push_back({k, node});
  return left.size() == terms.size() ? g_.add(a.nominal, a.delta) : g_.sum(number, left);
}

Dual Translator::product(const Dual& a, const Dual& b) {
  const NodeId delta = g_.add(g_.product(a.nominal, b.delta), g_.product(a.delta, actual(b)));
  return {g_.product(a.nominal, b.nominal), delta};
}

Dual Translator::lag(const Dual& u, const Dual& tau) {
  const auto nominal = g_.constant_value(tau.nominal), change = g_.constant_value(tau.delta);
  if (!nominal || !change) throw std::domain_error("the time constant of a lag must be constant");
  const NodeId at_nominal = g_.lag(u.nominal, *nominal);
  if (*change == 0) return {at_nominal, g_.lag(u.delta, *nominal)};
  return {at_nominal, g_.subtract(g_.lag(actual(u), *nominal + *change), at_nominal)};
}

// Products of such values, which derivatives and bounds need, stay finite; no fixed-point number holds them.
void Translator::refuse_beyond_numbers(NodeId id) const {
  constexpr double kLargest = 1e100;  // its cube is finite in double precision (at most 1.8e308)
  if (!(g_[id].range.magnitude() <= kLargest))
    throw std::domain_error("a value of the equation can exceed 1e100 over the ranges of the axes");
}

// An even power is a square, whose range is not negative.
NodeId Translator::whole_power(NodeId base, int n) {
  if (n == 0) return g_.constant(1);
  if (n % 2 != 0) return g_.product(whole_power(base, n - 1), base);
  const NodeId half = whole_power(base, n / 2);
  return g_.product(half, half);
}

NodeId Translator::power(NodeId base, NodeId exponent) {
  const auto n = g_.constant_value(exponent);
  if (const auto b = g_.constant_value(base); n && b) return g_.constant(std::pow(*b, *n));
  if (n && *n == std::round(*n) && std::abs(*n) <= 16) {
    const NodeId result = whole_power(base, std::abs(static_cast<int>(*n)));
    refuse_beyond_numbers(result);
    return *n < 0 ? g_.function(Function::kReciprocal, result) : result;
  }
  if (n && *n == 0.5) return g_.function(Function::kSqrt, base);
  return g_.function(Function::kExp, g_.product(exponent, g_.function(Function::kLog, base)));
}

// atan2 over the half plane in which one of the two operands keeps its sign. Elsewhere it has a
// step.
NodeId Translator::angle_of(NodeId y, NodeId x) {
  const auto v = g_.constant_value(y), u = g_.constant_value(x);
  if (v && u) return g_.constant(model::apply(model::Op::kAtan2, *v, *u));
  const Interval along = g_[x].range, across = g_[y].range;
  if (along.low > 0)
    return g_.function(Function::kArcTangent, g_.product(y, g_.function(Function::kReciprocal, x)));
  if (across.contains(0))
    throw std::domain_error("atan2 whose operands can both reach zero or turn through 180 deg");
  const NodeId cotangent = g_.product(x, g_.function(Function::kReciprocal, y));
  return g_.sum(across.low > 0 ? 90 : -90, {{-1, g_.function(Function::kArcTangent, cotangent)}});
}

NodeId Translator::apply_to(model::Op op, NodeId a, NodeId b) {
  switch (op) {
    case model::Op::kDivide:
      return g_.product(a, g_.function(Function::kReciprocal, b));
    case model::Op::kPower:
      return power(a, b);
    case model::Op::kEqual:
      return g_.choice(NodeKind::kEqual, a, b);
    case model::Op::kLess:
      return g_.choice(NodeKind::kLess, a, b);
    case model::Op::kGreater:
      return g_.choice(NodeKind::kLess, b, a);
    case model::Op::kSin:
      return g_.function(Function::kSin, a);
    case model::Op::kCos:
      return g_.function(Function::kCos, a);
    case model::Op::kTan:
      return g_.product(g_.function(Function::kSin, a),
                        g_.function(Function::kReciprocal, g_.function(Function::kCos, a)));
    case model::Op::kAtan2:
      return angle_of(a, b);
    case model::Op::kSqrt:
      return g_.function(Function::kSqrt, a);
    case model::Op::kAbs:
      return g_.choice(NodeKind::kAbs, a, a);
    case model::Op::kExp:
      return g_.function(Function::kExp, a);
    case model::Op::kLog:
      return g_.function(Function::kLog, a);
    case model::Op::kSign:
      return g_.choice(NodeKind::kSign, a, a);
    case model::Op::kMin:
      return g_.choice(NodeKind::kMin, a, b);
    case model::Op::kMax:
      return g_.choice(NodeKind::kMax, a, b);
    default:
      throw std::domain_error("the equation contains an operation that a compiled image does not support");
  }
}

Dual Translator::visit(const model::Expr& expr) {
  if (expr.op == model::Op::kNumber) return constant(expr.number, 0);
  if (expr.op == model::Op::kSymbol) return symbol(expr);
  if (expr.op == model::Op::kRunIs) {
    note(fmt::format("run(\"{}\") is 0 in an image, because it refers to a run of a measurement", expr.name));
    return constant(0, 0);
  }
  const Dual a = visit(*expr.args[0]);
  const Dual b = expr.args.size() > 1 ? visit(*expr.args[1]) : a;
  switch (expr.op) {
    case model::Op::kNegate:
      return {g_.scale(-1, a.nominal), g_.scale(-1, a.delta)};
    case model::Op::kAdd:
      return {g_.add(a.nominal, b.nominal), g_.add(a.delta, b.delta)};
    case model::Op::kSubtract:
      return {g_.subtract(a.nominal, b.nominal), g_.subtract(a.delta, b.delta)};
    case model::Op::kMultiply:
      return product(a, b);
    case model::Op::kLag:
      return lag(a, b);
    default:
      break;
  }
  if (expr.op == model::Op::kEqual || expr.op == model::Op::kLess || expr.op == model::Op::kGreater ||
      expr.op == model::Op::kSign)
    note_step(model::to_text(expr));
  const NodeId nominal = apply_to(expr.op, a.nominal, b.nominal);
  if (g_.is_zero(a.delta) && g_.is_zero(b.delta)) return {nominal, g_.constant(0)};
  if (expr.op == model::Op::kDivide && g_.is_zero(b.delta))
    return {nominal, apply_to(model::Op::kDivide, a.delta, b.nominal)};
  return {nominal, g_.subtract(apply_to(expr.op, actual(a), actual(b)), nominal)};
}

Dual Translator::translate(const model::Expr& expr, const std::string& text, std::size_t line) {
  try {
    const Dual value = visit(expr);
    for (const NodeId id : {value.nominal, value.delta}) refuse_beyond_numbers(id);
    return value;
  } catch (const std::domain_error& reason) {
    throw text::InputError({machine_.file, line}, text,
                           std::string("cannot be compiled: it has ") + reason.what());
  }
}

}  // namespace vernier::compile
