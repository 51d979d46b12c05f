// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/walk.h"

#include <cmath>
#include <utility>

#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

/// Splits an expression into the terms of its sum, each with its own share of the expression's
/// delta.
void split(const model::Expr& expr, double sign, Translator& translate, Graph& g, std::size_t line,
           std::vector<Step::Part>& parts) {
  if (expr.op == model::Op::kAdd || expr.op == model::Op::kSubtract || expr.op == model::Op::kNegate) {
    const double second = expr.op == model::Op::kAdd ? sign : -sign;
    split(*expr.args[0], expr.op == model::Op::kNegate ? -sign : sign, translate, g, line, parts);
    if (expr.op != model::Op::kNegate) split(*expr.args[1], second, translate, g, line, parts);
    return;
  }
  const std::string text = model::to_text(expr);
  const NodeId delta = g.scale(sign, translate.translate(expr, text, line).delta);
  if (!g.is_zero(delta)) parts.push_back({(sign < 0 ? "-" : "") + text, delta});
}

/// Returns the elementary steps of one transform in the order in which they act on a point beyond
/// it.
std::vector<Step> steps_of(const model::Transform& t, const char* branch, Translator& translate,
                           Graph& graph) {
  std::vector<Step> steps;
  const auto push = [&](bool turn, int axis, std::size_t dof) {
    const std::string where =
        std::string(t.dof_name(dof)) + " of transform " + std::to_string(t.n) + " (" + branch + ")";
    steps.push_back({turn, axis, translate.translate(*t.dof[dof], t.text[dof], t.line), where, {}});
    split(*t.dof[dof], 1, translate, graph, t.line, steps.back().parts);
  };
  if (t.kind == model::TransformKind::kSixDof) {
    for (int axis = 2; axis >= 0; --axis) push(true, axis, static_cast<std::size_t>(axis) + 3);
    for (int axis = 0; axis < 3; ++axis) push(false, axis, static_cast<std::size_t>(axis));
  } else {
    push(true, 0, 3);   // alpha
    push(false, 0, 2);  // a
    push(true, 2, 0);   // theta
    push(false, 2, 1);  // d
  }
  return steps;
}

// Cosine and sine. They are exact if the angle is a multiple of 90 deg, so that a machine with
// right angles stays sparse.
std::pair<NodeId, NodeId> direction_of(Graph& g, NodeId angle_deg) {
  const auto value = g.constant_value(angle_deg);
  if (!value) return {g.function(Function::kCos, angle_deg), g.function(Function::kSin, angle_deg)};
  const double quarter = *value / 90;
  if (quarter != std::round(quarter))
    return {g.constant(std::cos(*value * maths::kRadPerDeg)),
            g.constant(std::sin(*value * maths::kRadPerDeg))};
  const int q = ((static_cast<int>(std::fmod(quarter, 4)) % 4) + 4) % 4;
  constexpr std::array<double, 4> kCosine = {1, 0, -1, 0}, kSine = {0, 1, 0, -1};
  return {g.constant(kCosine[static_cast<std::size_t>(q)]), g.constant(kSine[static_cast<std::size_t>(q)])};
}

}  // namespace

NodeVector turned(Graph& g, const NodeVector& v, const Turn& turn) {
  const auto [c, s] = direction_of(g, g.scale(turn.sense, turn.angle_deg));
  const auto a = static_cast<std::size_t>((turn.axis + 1) % 3),
             b = static_cast<std::size_t>((turn.axis + 2) % 3);
  NodeVector out = v;
  out[a] = g.subtract(g.product(c, v[a]), g.product(s, v[b]));
  out[b] = g.add(g.product(s, v[a]), g.product(c, v[b]));
  return out;
}

NodeVector omitted_part(Graph& g, const Neglected& n) {
  const auto a = static_cast<std::size_t>((n.turn.axis + 1) % 3),
             b = static_cast<std::size_t>((n.turn.axis + 2) % 3);
  const NodeId angle = g.scale(maths::kRadPerDeg, n.turn.angle_deg);
  NodeId sine = g.constant(0), bend = g.constant(0);
  if (n.order == 0) {
    sine = g.function(Function::kSin, n.turn.angle_deg);
    bend = g.sum(1, {{-1, g.function(Function::kCos, n.turn.angle_deg)}});
  } else {
    // sin x = x - x^3 / 6 + x^5 / 120, 1 - cos x = x^2 / 2 - x^4 / 24 + x^6 / 720.
    double factor = n.order % 4 < 2 ? 1 : -1;
    if (n.order % 2 == 0) factor = -factor;
    NodeId power = angle;
    for (int i = 2; i <= n.order; ++i) {
      power = g.product(power, angle);
      factor /= i;
    }
    (n.order % 2 == 0 ? bend : sine) = g.scale(factor, power);
  }
  NodeVector v;
  v.fill(g.constant(0));
  v[a] = g.sum(0, {{-1, g.product(bend, n.of[a])}, {-1, g.product(sine, n.of[b])}});
  v[b] = g.sum(0, {{1, g.product(sine, n.of[a])}, {-1, g.product(bend, n.of[b])}});
  for (const Turn& turn : n.to_frame) v = turned(g, v, turn);
  return v;
}

std::vector<Step> all_steps(const model::Machine& machine, Translator& translate, Graph& graph) {
  std::vector<Step> steps;
  for (auto t = machine.tool.rbegin(); t != machine.tool.rend(); ++t)
    for (Step& step : steps_of(*t, "tool", translate, graph)) steps.push_back(std::move(step));
  for (const model::Transform& t : machine.workpiece) {
    std::vector<Step> back = steps_of(t, "workpiece", translate, graph);
    for (auto step = back.rbegin(); step != back.rend(); ++step) {
      step->by = {graph.scale(-1, step->by.nominal), graph.scale(-1, step->by.delta)};
      for (Step::Part& part : step->parts) part.delta = graph.scale(-1, part.delta);
      steps.push_back(std::move(*step));
    }
  }
  return steps;
}

NodeVector motion_of(Graph& g, NodeId axis, const NodeVector& point, const Step* last_turn) {
  NodeVector column{};
  Derivative by_axis(g, axis);
  for (std::size_t c = 0; c < 3; ++c) column[c] = by_axis.of(point[c]);
  if (last_turn == nullptr) return column;
  const NodeId speed = g.scale(maths::kRadPerDeg, by_axis.of(last_turn->by.nominal));
  const auto a = static_cast<std::size_t>((last_turn->axis + 1) % 3),
             b = static_cast<std::size_t>((last_turn->axis + 2) % 3);
  column[a] = g.subtract(column[a], g.product(speed, point[b]));
  column[b] = g.add(column[b], g.product(speed, point[a]));
  return column;
}

Walk walked(const model::Machine& machine, Derivation& derivation, const Additions& added,
            std::size_t frozen_from, Walk walk) {
  Translator translate(machine, derivation, added);
  const std::vector<Step> steps = all_steps(machine, translate, derivation.graph);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i == frozen_from) walk.freeze();
    walk.take(steps[i]);
  }
  return walk;
}

Walk::Walk(Derivation& derivation, double neglect_mm, std::vector<Neglected>& neglected)
    : g_(derivation.graph), neglect_mm_(neglect_mm), neglected_(neglected) {
  nominal_.fill(g_.constant(0));
  deviation_.fill(g_.constant(0));
}

Walk Walk::of_direction(Derivation& derivation, double neglect, std::vector<Neglected>& neglected) {
  Walk walk(derivation, neglect, neglected);
  walk.direction_ = true;
  walk.nominal_[2] = walk.g_.constant(1);
  walk.reach_mm_ = 1;
  return walk;
}

void Walk::take(const Step& step) {
  if (step.turn) {
    deviate_by_turn(step);
    turn_nominal(step);
  } else if (!direction_) {
    const auto axis = static_cast<std::size_t>(step.axis);
    add_deviation(only(axis, step.by.delta));
    for (const Step::Part& part : step.parts)
      add_part(step.where + ": " + part.term, seen_from_frame(only(axis, part.delta)));
    nominal_[axis] = g_.add(nominal_[axis], step.by.nominal);
    reach_mm_ += g_[step.by.nominal].range.magnitude();
    spread_mm_ += g_[step.by.delta].range.magnitude();
  }
}

NodeVector Walk::only(std::size_t axis, NodeId value) {
  NodeVector v;
  v.fill(g_.constant(0));
  v[axis] = value;
  return v;
}

NodeVector Walk::plus(const NodeVector& a, const NodeVector& b) {
  return {g_.add(a[0], b[0]), g_.add(a[1], b[1]), g_.add(a[2], b[2])};
}

double Walk::norm_of(const NodeVector& v) const {
  double sum = 0;
  for (const NodeId id : v) sum += g_[id].range.magnitude() * g_[id].range.magnitude();
  return std::sqrt(sum);
}

double Walk::reach_mm() const { return std::min(reach_mm_, norm_of(nominal_)); }
double Walk::spread_mm() const { return std::min(spread_mm_, norm_of(deviation_)); }

void Walk::turn_nominal(const Step& step) {
  if (g_.is_zero(step.by.nominal)) return;
  const Turn turn{step.axis, step.by.nominal};
  nominal_ = turned(g_, nominal_, turn);
  if (frozen_) {
    turns_.push_back(step);
  } else {
    deviation_ = turned(g_, deviation_, turn);
    for (auto& [name, part] : parts_) part = turned(g_, part, turn);
    for (Neglected& n : neglected_) {
      turn_sizes(n.along_mm, step.axis, step.by.nominal);
      n.to_frame.push_back(turn);
    }
  }
}

NodeVector Walk::deviation_here() {
  NodeVector v = deviation_;
  for (const Step& step : turns_) v = turned(g_, v, {step.axis, step.by.nominal});
  return v;
}

NodeVector Walk::seen_from_frame(NodeVector v) {
  for (auto step = turns_.rbegin(); step != turns_.rend(); ++step)
    v = turned(g_, v, {step->axis, step->by.nominal, -1});
  return v;
}

void Walk::add_deviation(const NodeVector& v) { deviation_ = plus(deviation_, seen_from_frame(v)); }

void Walk::add_part(const std::string& name, const NodeVector& v) {
  const auto [place, fresh] = parts_.emplace(name, v);
  if (!fresh) place->second = plus(place->second, v);
}

// The terms of a rotation share its linear part. The nonlinear part belongs to the rotation as a
// whole.
void Walk::split_turn(const Step& step, const NodeVector& point, const NodeVector& all) {
  const auto a = static_cast<std::size_t>((step.axis + 1) % 3),
             b = static_cast<std::size_t>((step.axis + 2) % 3);
  const auto total = g_.constant_value(step.by.delta);
  NodeVector rest = all;
  for (const Step::Part& part : step.parts) {
    NodeVector share = only(a, g_.constant(0));
    const auto own = g_.constant_value(part.delta);
    for (const std::size_t c : {a, b}) {
      share[c] = total && own ? g_.scale(*own / *total, all[c])
                              : g_.scale(c == a ? -maths::kRadPerDeg : maths::kRadPerDeg,
                                         g_.product(part.delta, point[c == a ? b : a]));
      rest[c] = g_.subtract(rest[c], share[c]);
    }
    add_part(step.where + ": " + part.term, seen_from_frame(share));
  }
  if (!total && !(g_.is_zero(rest[a]) && g_.is_zero(rest[b])))
    add_part(step.where + ": higher orders", seen_from_frame(rest));
}

double Walk::size_of(const Step& step) const {
  return g_[step.by.delta].range.magnitude() * maths::kRadPerDeg;
}

// The omitted part of a rotation is perpendicular to its axis.
bool Walk::small(double bound_mm, const Step& step, const NodeVector& of, int order, const char* what) {
  if (bound_mm > neglect_mm_) return false;
  if (bound_mm == 0) return true;
  Neglected n{what + step.where, bound_mm, {bound_mm, bound_mm, bound_mm}};
  n.along_mm[static_cast<std::size_t>(step.axis)] = 0;
  n.turn = {step.axis, step.by.delta};
  n.of = of;
  n.order = order;
  // The next order of a sine or cosine is smaller by at least the square of the angle over 12.
  if (order > 0) n.slack_mm = bound_mm * std::pow(size_of(step), 2) / 12;
  for (auto turn = turns_.rbegin(); turn != turns_.rend(); ++turn) {
    turn_sizes(n.along_mm, turn->axis, turn->by.nominal);
    n.to_frame.push_back({turn->axis, turn->by.nominal, -1});
  }
  neglected_.push_back(std::move(n));
  return true;
}

// Sizes of components after a rotation. The size of a cosine or sine does not depend on its
// direction.
void Walk::turn_sizes(std::array<double, 3>& sizes, int axis, NodeId angle_deg) {
  const auto [c, s] = direction_of(g_, angle_deg);
  const double cosine = g_[c].range.magnitude(), sine = g_[s].range.magnitude();
  double &a = sizes[static_cast<std::size_t>((axis + 1) % 3)],
         &b = sizes[static_cast<std::size_t>((axis + 2) % 3)];
  const double most = std::hypot(a, b), turned_a = cosine * a + sine * b, turned_b = sine * a + cosine * b;
  a = std::min(turned_a, most);
  b = std::min(turned_b, most);
}

// (R(delta) - 1) (nominal + deviation): sine and 1 - cosine of the small angle by their series, up
// to the relevant order.
void Walk::deviate_by_turn(const Step& step) {
  if (g_.is_zero(step.by.delta)) return;
  const auto a = static_cast<std::size_t>((step.axis + 1) % 3),
             b = static_cast<std::size_t>((step.axis + 2) % 3);
  const double size = size_of(step);
  // The error equation does not rotate what it has omitted.
  for (Neglected& n : neglected_) n.slack_mm += n.bound_mm * size;
  NodeVector point = nominal_;
  const NodeVector so_far = deviation_here();
  const NodeVector across = {g_.constant(0), so_far[a], so_far[b]};
  const double across_mm = std::min(spread_mm_, norm_of(across)),
               nominal_mm = std::min(reach_mm_, norm_of({g_.constant(0), point[a], point[b]}));
  double reach = nominal_mm;
  if (!small(2 * std::sin(std::min(size, 3.0) / 2) * across_mm, step, so_far, 0,
             "turn of the deviation by ")) {
    point = plus(point, so_far);
    reach += across_mm;
  }
  spread_mm_ += 2 * std::sin(std::min(size, 3.0) / 2) * (nominal_mm + across_mm);
  const NodeId sine = sine_of(step, point, size, reach), bend = bend_of(step, point, size, reach);
  NodeVector moved;
  moved.fill(g_.constant(0));
  moved[a] = g_.sum(0, {{-1, g_.product(bend, point[a])}, {-1, g_.product(sine, point[b])}});
  moved[b] = g_.sum(0, {{1, g_.product(sine, point[a])}, {-1, g_.product(bend, point[b])}});
  add_deviation(moved);
  split_turn(step, point, moved);
}

NodeId Walk::sine_of(const Step& step, const NodeVector& point, double size, double reach) {
  if (const auto angle = g_.constant_value(step.by.delta))
    return g_.constant(std::sin(*angle * maths::kRadPerDeg));
  const NodeId angle = g_.scale(maths::kRadPerDeg, step.by.delta);
  if (small(std::pow(size, 3) / 6 * reach, step, point, 3, "third order of ")) return angle;
  if (small(std::pow(size, 5) / 120 * reach, step, point, 5, "fifth order of "))
    return g_.sum(0, {{1, angle}, {-1.0 / 6, g_.product(angle, g_.product(angle, angle))}});
  return g_.function(Function::kSin, step.by.delta);
}

NodeId Walk::bend_of(const Step& step, const NodeVector& point, double size, double reach) {
  if (const auto angle = g_.constant_value(step.by.delta))
    return g_.constant(1 - std::cos(*angle * maths::kRadPerDeg));
  if (small(size * size / 2 * reach, step, point, 2, "second order of ")) return g_.constant(0);
  const NodeId angle = g_.scale(maths::kRadPerDeg, step.by.delta), square = g_.product(angle, angle);
  if (small(std::pow(size, 4) / 24 * reach, step, point, 4, "fourth order of ")) return g_.scale(0.5, square);
  if (small(std::pow(size, 6) / 720 * reach, step, point, 6, "sixth order of "))
    return g_.sum(0, {{0.5, square}, {-1.0 / 24, g_.product(square, square)}});
  return g_.sum(1, {{-1, g_.function(Function::kCos, step.by.delta)}});
}

}  // namespace vernier::compile
