// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/compile/solve.h"
#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

/// A column this small relative to 1 rad per rad has no influence on the tilt.
constexpr double kTiltsNothing = 1e-9;
/// One pair of axes is better than one nearer to the tool if its determinant is larger by this factor.
constexpr double kBetter = 1.05;

/// Motion of the nominal direction of the tool with an axis, per deg divided by `lever`: length at
/// most 1.
struct Tilt {
  std::size_t axis;
  NodeVector direction;
  double lever;
};

NodeId dot(Graph& g, const NodeVector& a, const NodeVector& b) {
  return g.sum(0, {{1, g.product(a[0], b[0])}, {1, g.product(a[1], b[1])}, {1, g.product(a[2], b[2])}});
}

NodeId simplified(Graph& g, NodeId node) {
  if (g.constant_value(node)) return node;
  Samples samples(g, kSamples);
  const auto value = sampled_constant(samples, node);
  return value ? g.constant(*value) : node;
}

Eigen::ArrayXd sampled(const Graph& g, NodeId node) { return Samples(g, kSamples).of(node); }

/// The chain in the order in which it acts on the direction, up to its last rotation by an axis.
class DirectionChain {
 public:
  DirectionChain(const model::Machine& machine, Derivation& d, double neglect)
      : machine_(machine), d_(d), translate_(machine, d), steps_(all_steps(machine, translate_, d.graph)) {
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (steps_[i].turn && turns_by_axis(i)) last_ = i;
    if (!last_) return;
    std::vector<Neglected> unused;
    Walk walk = Walk::of_direction(d, neglect, unused);
    for (std::size_t i = 0; i < *last_; ++i) walk.take(steps_[i]);
    direction_ = walk.nominal();
  }

  std::optional<std::size_t> last_turn() const { return last_; }

  /// Returns the axes that tilt the tool, nearest to it first.
  std::vector<Tilt> tilts() {
    std::vector<std::size_t> order;
    for (const Step& step : steps_)
      for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
        if (step.turn && machine_.axes[axis].rotary && d_.graph.depends_on(step.by.nominal, channel(axis)) &&
            std::find(order.begin(), order.end(), axis) == order.end())
          order.push_back(axis);
    std::vector<Tilt> tilts;
    for (const std::size_t axis : order)
      if (const auto tilt = tilt_of(axis)) tilts.push_back(*tilt);
    return tilts;
  }

 private:
  NodeId channel(std::size_t axis) { return translate_.channel(ChannelKind::kPosition, axis); }
  bool turns_by_axis(std::size_t i) {
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      if (machine_.axes[axis].rotary && d_.graph.depends_on(steps_[i].by.nominal, channel(axis))) return true;
    return false;
  }
  std::optional<Tilt> tilt_of(std::size_t axis) {
    Graph& g = d_.graph;
    try {
      NodeVector direction = motion_of(g, channel(axis), direction_, &steps_[*last_]);
      Derivative by_axis(g, channel(axis));
      double speed = 0;
      for (const Step& step : steps_)
        if (step.turn) speed += maths::kRadPerDeg * g[by_axis.of(step.by.nominal)].range.magnitude();
      Eigen::ArrayXd length = Eigen::ArrayXd::Zero(kSamples);
      for (const NodeId component : direction) length += sampled(g, component).square();
      if (length.maxCoeff() < kTiltsNothing * kTiltsNothing) return std::nullopt;
      const double lever = std::exp2(std::ceil(std::log2(speed)));
      for (NodeId& component : direction) component = simplified(g, g.scale(1 / lever, component));
      return Tilt{axis, direction, lever};
    } catch (const std::domain_error& reason) {
      throw text::InputError(
          {machine_.file, machine_.axes[axis].line}, machine_.axes[axis].name,
          std::string("the motion of this axis in the nominal chain cannot be compiled: ") + reason.what());
    }
  }

  const model::Machine& machine_;
  Derivation& d_;
  Translator translate_;
  std::vector<Step> steps_;
  std::optional<std::size_t> last_;
  NodeVector direction_{};
};

/// J'J of one or two tilts, and its inverse if they are damped.
struct Normal {
  std::vector<std::vector<NodeId>> square;  // J'J
  NodeId determinant = 0;
};

Normal normal_of(Graph& g, const std::vector<Tilt>& tilts) {
  Normal n;
  n.square.assign(tilts.size(), std::vector<NodeId>(tilts.size()));
  for (std::size_t i = 0; i < tilts.size(); ++i)
    for (std::size_t k = i; k < tilts.size(); ++k)
      n.square[i][k] = n.square[k][i] =
          simplified(g, i == k ? dot(g, tilts[i].direction, tilts[i].direction)
                               : dot(g, tilts[i].direction, tilts[k].direction));
  n.determinant = n.square[0][0];
  if (tilts.size() == 2)
    n.determinant = simplified(
        g, g.subtract(g.product(n.square[0][0], n.square[1][1]), g.product(n.square[0][1], n.square[0][1])));
  return n;
}

/// A determinant that nine of ten sampled poses exceed.
double usual(const Graph& g, NodeId determinant) {
  Eigen::ArrayXd values = sampled(g, determinant);
  const auto place = values.data() + kSamples / 10;
  std::nth_element(values.data(), place, values.data() + kSamples);
  return *place;
}

std::vector<Tilt> best_pair(Graph& g, const std::vector<Tilt>& tilts) {
  if (tilts.size() < 2) return tilts;
  std::vector<Tilt> best;
  double most = 0;
  for (std::size_t i = 0; i < tilts.size(); ++i)
    for (std::size_t k = i + 1; k < tilts.size(); ++k) {
      const std::vector<Tilt> pair = {tilts[i], tilts[k]};
      const NodeId determinant = normal_of(g, pair).determinant;
      if (sampled(g, determinant).maxCoeff() < kTiltsNothing) continue;
      const double here = usual(g, determinant);
      if (best.empty() || here > kBetter * most) most = here, best = pair;
    }
  return best.empty() ? std::vector<Tilt>{tilts.front()} : best;
}

/// Properties of the determinant: the range of damping, and its reciprocal with damping.
struct Damping {
  NodeId lambda = 0, reciprocal = 0;  // of det(J'J + lambda)
  double floor = 0, gain = 0;   // det below floor: damped; upper bound of |(J'J + lambda)^-1 J'|, approximate
  std::optional<double> share;  // of the poses
};

Damping damped(Graph& g, const Normal& n) {
  Damping result;
  const Eigen::ArrayXd seen = sampled(g, n.determinant);
  result.floor = kFloorShare * seen.maxCoeff();
  double low = g[n.determinant].range.low, trace = 1;
  if (n.square.size() == 2) trace = g[n.square[0][0]].range.high + g[n.square[1][1]].range.high;
  if (low < result.floor && seen.minCoeff() > result.floor)
    low = lower_bound_of(g, n.determinant, kBoxes) * (1 - 1e-6);
  NodeId determinant = n.determinant;
  result.lambda = g.constant(0);
  if (low > result.floor) {
    result.floor = low;
  } else {
    result.share = static_cast<double>((seen < result.floor).count()) / static_cast<double>(kSamples);
    result.lambda =
        g.choice(NodeKind::kMax, g.sum(result.floor / trace, {{-1 / trace, n.determinant}}), g.constant(0));
    const auto plus = [&](NodeId entry) { return g.add(entry, result.lambda); };
    determinant = plus(n.square[0][0]);
    if (n.square.size() == 2)
      determinant =
          g.subtract(g.product(determinant, plus(n.square[1][1])), g.product(n.square[0][1], n.square[0][1]));
    // Both eigenvalues are at least lambda. Their product is at least floor / 2 for axes that
    // rotate at the same rate.
    low = 0.5 * sampled(g, determinant).minCoeff();
  }
  if (g[determinant].range.low < low) determinant = g.choice(NodeKind::kMax, determinant, g.constant(low));
  result.reciprocal = g.function(Function::kReciprocal, determinant);
  result.gain = (result.share ? 1.5 : 1) / std::sqrt(result.floor / trace);
  return result;
}

std::string list_of(const model::Machine& machine, const std::vector<std::size_t>& axes) {
  std::string names;
  for (const std::size_t axis : axes)
    names += (names.empty() ? "" : axis == axes.back() ? " and " : ", ") + machine.axes[axis].name;
  return names;
}

void add_notes(const model::Machine& machine, Derivation& d, const Orientation& o) {
  d.notes.push_back(
      fmt::format("rotary axes that correct the direction of the tool: {}", list_of(machine, o.axes)));
  if (o.axes.size() == 1)
    d.notes.push_back(
        "only one rotary axis tilts the tool, so the image corrects only the tilt about the direction of "
        "this axis");
  if (o.damped)
    d.notes.push_back(
        fmt::format("the rotary axes {} tilt the tool in the same direction in some poses: near these poses "
                    "(about {:.1f} % of the declared ranges) the correction of the tool direction is damped",
                    list_of(machine, o.axes), 100 * *o.damped));
  for (std::size_t k = 0; k < o.axes.size(); ++k) {
    const model::Axis& axis = machine.axes[o.axes[k]];
    if (!axis.max_correction)
      d.notes.push_back(fmt::format(
          "axis {} has no maxcorrection: its correction of the tool direction may reach {:.3g} deg",
          axis.name, o.limit_deg[k]));
    if (!axis.max_slew)
      d.notes.push_back(fmt::format(
          "a corrected rotary axis has no maxslew, so the speed of its correction is not limited: {}",
          axis.name));
  }
}

}  // namespace

NodeId held_within(Graph& g, NodeId value, double limit) {
  if (g.constant_value(value)) return value;
  const Interval range = g[value].range;
  const NodeId above = g.choice(NodeKind::kMax, value, g.constant(std::max(range.low, -limit)));
  return range.high > limit ? g.choice(NodeKind::kMin, above, g.constant(limit)) : above;
}

std::optional<Tilting> solve_direction(const model::Machine& machine, Derivation& d, double neglect) {
  Graph& g = d.graph;
  DirectionChain chain(machine, d, neglect);
  if (!chain.last_turn()) return std::nullopt;
  const std::vector<Tilt> tilts = best_pair(g, chain.tilts());
  if (tilts.empty()) return std::nullopt;
  const Normal normal = normal_of(g, tilts);
  const Damping damping = damped(g, normal);
  Tilting result;
  result.frozen_from = *chain.last_turn();
  result.solve = [tilts, normal, damping](Graph& graph, const NodeVector& v,
                                          const std::vector<NodeId>& so_far) {
    std::vector<NodeId> along, x;
    for (std::size_t i = 0; i < tilts.size(); ++i) {
      along.push_back(dot(graph, tilts[i].direction, v));
      if (!so_far.empty())
        along[i] = graph.sum(0, {{1, along[i]}, {-tilts[i].lever, graph.product(damping.lambda, so_far[i])}});
    }
    for (std::size_t i = 0; i < tilts.size(); ++i) {
      NodeId weight = along[i];
      if (tilts.size() == 2) {
        const std::size_t k = 1 - i;
        weight = graph.subtract(graph.product(graph.add(normal.square[k][k], damping.lambda), along[i]),
                                graph.product(normal.square[0][1], along[k]));
      }
      x.push_back(graph.scale(1 / tilts[i].lever, graph.product(damping.reciprocal, weight)));
    }
    return x;
  };
  Orientation o;
  const Walk walk = walked(machine, d, {}, result.frozen_from, Walk::of_direction(d, neglect, o.neglected));
  o.deviation = walk.deviation();
  o.spread = walk.spread_mm();
  o.determinant = normal.determinant;
  o.floor = damping.floor;
  o.damped = damping.share;
  o.gain = damping.gain;
  const std::vector<NodeId> x = result.solve(g, o.deviation, {});
  for (std::size_t k = 0; k < tilts.size(); ++k) {
    const model::Axis& axis = machine.axes[tilts[k].axis];
    o.axes.push_back(tilts[k].axis);
    o.lever.push_back(tilts[k].lever);
    const double reach = damping.gain * o.spread / tilts[k].lever;
    o.limit_deg.push_back(std::min(reach, axis.max_correction.value_or(reach)));
    o.values.push_back(held_within(g, x[k], o.limit_deg.back()));
  }
  for (const auto& [name, part] : walk.parts()) o.parts.push_back({name, part, result.solve(g, part, {})});
  add_notes(machine, d, o);
  d.orientation = std::move(o);
  return result;
}

std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states) {
  std::vector<bool> result(states.count, false);
  Derivation d;
  if (!machine.correct_orientation || !solve_direction(machine, d, kTiltsNothing) || !d.orientation->damped)
    return result;
  Samples values(d.graph, static_cast<Eigen::Index>(states.count));
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    values.set(d.graph.channel(ChannelKind::kPosition, static_cast<std::uint32_t>(i), axis_range(machine, i)),
               states.axis[i]);
  const Eigen::ArrayXd& determinant = values.of(d.orientation->determinant);
  for (std::size_t i = 0; i < states.count; ++i)
    result[i] = determinant[static_cast<Eigen::Index>(i)] < d.orientation->floor;
  return result;
}

}  // namespace vernier::compile
