// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/evaluate.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/maths/factors.h"

namespace vernier::model {
namespace {

template <class F>
Value map(const Value& a, std::size_t count, const F& f) {
  if (!a.varies()) return Value(f(a[0]));
  Column result(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) result[static_cast<Eigen::Index>(i)] = f(a[i]);
  return Value(std::move(result));
}

template <class F>
Value map(const Value& a, const Value& b, std::size_t count, const F& f) {
  if (!a.varies() && !b.varies()) return Value(f(a[0], b[0]));
  Column result(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) result[static_cast<Eigen::Index>(i)] = f(a[i], b[i]);
  return Value(std::move(result));
}

/// Partial derivatives of an operation: d op(a, b) / da and / db.
double by_first(Op op, double a, double b) {
  switch (op) {
    case Op::kNegate:
      return -1;
    case Op::kAdd:
    case Op::kSubtract:
      return 1;
    case Op::kMultiply:
      return b;
    case Op::kDivide:
      return 1 / b;
    case Op::kPower:
      return b == 0 ? 0 : b * std::pow(a, b - 1);
    case Op::kSin:
      return maths::kRadPerDeg * std::cos(a * maths::kRadPerDeg);
    case Op::kCos:
      return -maths::kRadPerDeg * std::sin(a * maths::kRadPerDeg);
    case Op::kTan:
      return maths::kRadPerDeg / (std::cos(a * maths::kRadPerDeg) * std::cos(a * maths::kRadPerDeg));
    case Op::kAtan2:
      return b / (a * a + b * b) / maths::kRadPerDeg;
    case Op::kSqrt:
      return 0.5 / std::sqrt(a);
    case Op::kAbs:
      return a > 0 ? 1 : a < 0 ? -1 : 0;
    case Op::kExp:
      return std::exp(a);
    case Op::kLog:
      return 1 / a;
    case Op::kMin:
      return a <= b ? 1 : 0;
    case Op::kMax:
      return a >= b ? 1 : 0;
    default:
      return 0;  // comparisons and sign are constant between their steps
  }
}

double by_second(Op op, double a, double b) {
  switch (op) {
    case Op::kAdd:
      return 1;
    case Op::kSubtract:
      return -1;
    case Op::kMultiply:
      return a;
    case Op::kDivide:
      return -a / (b * b);
    case Op::kPower:
      return a > 0 ? std::pow(a, b) * std::log(a) : 0;
    case Op::kAtan2:
      return -a / (a * a + b * b) / maths::kRadPerDeg;
    case Op::kMin:
      return a <= b ? 0 : 1;
    case Op::kMax:
      return a >= b ? 0 : 1;
    default:
      return 0;
  }
}

/// target += factor * source, for value and every derivative.
void accumulate(ValueAndSlopes& target, const ValueAndSlopes& source, const Value& factor,
                std::size_t count) {
  for (const auto& [key, derivative] : source.by) {
    Value term = map(derivative, factor, count, [](double x, double y) { return x * y; });
    bool found = false;
    for (auto& [other, sum] : target.by)
      if (other == key) {
        sum = map(sum, term, count, [](double x, double y) { return x + y; });
        found = true;
      }
    if (!found) target.by.emplace_back(key, std::move(term));
  }
}

/// Weights of one step of a first-order lag: y1 = e*y0 + p*u0 + q*u1. The input is linear between
/// two moments. The derivatives are by h = dt / tau.
struct LagStep {
  double e = 1, p = 0, q = 0, de = 0, dp = 0, dq = 0;
};
LagStep lag_step(double h) {
  LagStep step;
  step.e = std::exp(-h);
  const double g = h < 1e-5 ? 1 - h / 2 + h * h / 6 : (1 - step.e) / h;
  const double dg = h < 1e-5 ? -0.5 + h / 3 : (step.e - g) / h;
  step.p = g - step.e;
  step.q = 1 - g;
  step.de = -step.e;
  step.dp = dg + step.e;
  step.dq = -dg;
  return step;
}

}  // namespace

bool Value::all_finite() const { return varies_ ? each_.isFinite().all() : std::isfinite(all_); }

Column Value::column(std::size_t count) const {
  return varies_ ? each_ : Column::Constant(static_cast<Eigen::Index>(count), all_);
}

Evaluator::Evaluator(const Machine& machine, const States& states, std::vector<char> active)
    : machine_(machine), states_(states), active_(std::move(active)) {}

ValueAndSlopes Evaluator::operator()(const Expr& expr) {
  const std::size_t count = states_.count;
  if (expr.op == Op::kNumber) return {Value(expr.number), {}};
  if (expr.op == Op::kSymbol) return symbol(expr.symbol);
  if (expr.op == Op::kRunIs) return {run_is(expr.name), {}};
  const ValueAndSlopes a = (*this)(*expr.args[0]);
  const ValueAndSlopes b = expr.args.size() > 1 ? (*this)(*expr.args[1]) : ValueAndSlopes{};
  if (expr.op == Op::kLag) return lag(a, b);
  const Op op = expr.op;
  ValueAndSlopes result;
  result.value = map(a.value, b.value, count, [op](double x, double y) { return apply(op, x, y); });
  if (!a.by.empty())
    accumulate(result, a,
               map(a.value, b.value, count, [op](double x, double y) { return by_first(op, x, y); }), count);
  if (!b.by.empty())
    accumulate(result, b,
               map(a.value, b.value, count, [op](double x, double y) { return by_second(op, x, y); }), count);
  return result;
}

ValueAndSlopes Evaluator::symbol(const Symbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::kStatic: {
      ValueAndSlopes result{Value(machine_.statics[symbol.index].value), {}};
      if (active(symbol.index)) result.by.emplace_back(symbol.index, Value(1.0));
      return result;
    }
    case SymbolKind::kAxis: {
      const double scale = 1 + machine_.axes[symbol.index].scale_factor;
      ValueAndSlopes result{Value(Column(states_.axis[symbol.index] * scale)), {}};
      if (active(scale_key(symbol.index)))
        result.by.emplace_back(scale_key(symbol.index), Value(states_.axis[symbol.index]));
      return result;
    }
    case SymbolKind::kInput:
      return {Value(states_.input[symbol.index]), {}};
    case SymbolKind::kTableValue: {
      if (machine_.table_of(symbol.index / 6) == nullptr) return {};
      ValueAndSlopes result{table_value(symbol.index), {}};
      if (active(table_key(symbol.index))) result.by.emplace_back(table_key(symbol.index), Value(1.0));
      return result;
    }
    case SymbolKind::kVelocity:
      return {Value(states_.velocity[symbol.index]), {}};
    case SymbolKind::kAcceleration:
      return {Value(states_.acceleration[symbol.index]), {}};
    case SymbolKind::kDirection:
      return {Value(states_.direction[symbol.index]), {}};
    case SymbolKind::kSince:
      return {Value(states_.since[symbol.index]), {}};
    case SymbolKind::kFeed:
      return {Value(states_.feed), {}};
    case SymbolKind::kCurvature:
      return {Value(states_.curvature), {}};
    case SymbolKind::kNormal:
      return {Value(states_.normal[symbol.index]), {}};
    case SymbolKind::kTime:
      return {Value(states_.time), {}};
    case SymbolKind::kVisit:
      return {Value(states_.visit), {}};
    case SymbolKind::kUnresolved:
      break;
  }
  throw std::logic_error("an expression was not resolved against its machine");
}

Value Evaluator::table_value(std::size_t index) {
  const std::size_t axis = index / 6;
  const auto found = table_columns_.find(axis);
  if (found != table_columns_.end()) return Value(found->second[index % 6]);
  const StationTable table(*machine_.table_of(axis));
  std::vector<Column> columns(6, Column(static_cast<Eigen::Index>(states_.count)));
  for (std::size_t i = 0; i < states_.count; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const std::array<double, 6> six = table.values(states_.axis[axis][at]);
    for (std::size_t c = 0; c < 6; ++c) columns[c][at] = six[c];
  }
  return Value(table_columns_.emplace(axis, std::move(columns)).first->second[index % 6]);
}

Value Evaluator::run_is(const std::string& label) const {
  Column result(static_cast<Eigen::Index>(states_.count));
  for (std::size_t i = 0; i < states_.count; ++i)
    result[static_cast<Eigen::Index>(i)] = states_.run_names[states_.run[i]] == label ? 1 : 0;
  return Value(std::move(result));
}

ValueAndSlopes Evaluator::lag(const ValueAndSlopes& input, const ValueAndSlopes& tau) const {
  const auto n = static_cast<Eigen::Index>(states_.count);
  Column y(n), by_tau(n);
  std::vector<Column> by_input(input.by.size(), Column(n));
  std::vector<std::size_t> last(states_.names(states_.clock).size(),
                                states_.count);  // last row of each clock; count: no row yet
  for (std::size_t i = 0; i < states_.count; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const std::size_t clock = states_.of(states_.clock, i);
    std::size_t& before = last[clock];
    const auto from = static_cast<Eigen::Index>(before);
    LagStep step{0, 0, 1, 0, 0, 0};  // first row of a clock, or no lag: y = u
    double h_by_tau = 0;
    if (before < states_.count && tau.value[i] > 0) {
      const double dt = states_.time[at] - states_.time[from];
      if (dt < 0)
        throw text::InputError(fmt::format(
            "a term with lag requires rows in time order: t decreases from {} to {} s in run \"{}\"",
            std::to_string(states_.time[from]), std::to_string(states_.time[at]),
            states_.names(states_.clock)[clock]));
      step = lag_step(dt / tau.value[i]);
      h_by_tau = -dt / (tau.value[i] * tau.value[i]);
    }
    const bool first = before >= states_.count;
    const double y0 = first ? 0 : y[from], u0 = first ? 0 : input.value[before], u1 = input.value[i];
    y[at] = step.e * y0 + step.p * u0 + step.q * u1;
    by_tau[at] =
        (first ? 0 : step.e * by_tau[from]) + h_by_tau * (step.de * y0 + step.dp * u0 + step.dq * u1);
    for (std::size_t k = 0; k < by_input.size(); ++k) {
      const Value& d = input.by[k].second;
      by_input[k][at] = (first ? 0 : step.e * by_input[k][from] + step.p * d[before]) + step.q * d[i];
    }
    before = i;
  }
  ValueAndSlopes result{Value(std::move(y)), {}};
  for (std::size_t k = 0; k < by_input.size(); ++k)
    result.by.emplace_back(input.by[k].first, Value(by_input[k]));
  accumulate(result, tau, Value(std::move(by_tau)), states_.count);
  return result;
}

Column evaluate(const Machine& machine, const Expr& expr, const States& states) {
  return Evaluator(machine, states)(expr).value.column(states.count);
}

bool uses_lag(const Machine& machine) {
  bool found = false;
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        walk(*transform.dof[i], [&](const Expr& node) { found = found || node.op == Op::kLag; });
  return found;
}

}  // namespace vernier::model
