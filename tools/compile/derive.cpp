// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "tools/compile/orientation.h"
#include "tools/compile/solve.h"
#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/compile/walk.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

void check_machine(const model::Machine& machine) {
  for (const model::Static& s : machine.statics)
    if (!s.hidden && !s.nominal)
      throw text::InputError(
          {machine.file, s.line}, s.name,
          "a free constant (static) without `nominal` cannot be compiled; `fit` writes `nominal`");
  for (std::size_t i = 0; i < machine.axes.size(); ++i) axis_range(machine, i);
  if (machine.axes.size() > kMaxAxes || machine.inputs.size() > kMaxInputs)
    throw text::InputError({machine.file, 0}, machine.name,
                           "the machine file has more axes or inputs than an image can contain");
}

/// A derivation in progress. The corrected axes are chosen between its two halves.
class Attempt {
 public:
  /// begun: the part derived so far; added: the corrections of axes that it does not choose.
  Attempt(const model::Machine& machine, double neglect_mm, bool rotary_too, Derivation begun = {},
          const Additions& added = {})
      : machine_(machine),
        d_(std::move(begun)),
        translate_(machine, d_, added),
        steps_(all_steps(machine, translate_, d_.graph)),
        walk_(d_, neglect_mm, d_.neglected) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      if (!machine.axes[i].rotary || rotary_too) axes_.push_back(i);
    const std::size_t end = end_of_motion();
    // The last motion, if it is a rotation, is handled as one. Before it, no other vector has to
    // be rotated.
    const bool turn_last = end > 0 && steps_[end - 1].turn;
    frozen_from_ = turn_last ? end - 1 : end;
    for (std::size_t i = 0; i < frozen_from_; ++i) {
      taken_.push_back(walk_.reach_mm());
      walk_.take(steps_[i]);
    }
    find_columns(turn_last ? &steps_[end - 1] : nullptr);
    walk_.freeze();
    for (std::size_t i = frozen_from_; i < steps_.size(); ++i) {
      reach_mm_.push_back(walk_.reach_mm());
      walk_.take(steps_[i]);
    }
  }

  /// Steps of the chain before the frame of the deviation.
  std::size_t frozen_from() const { return frozen_from_; }
  /// mm of tool point per mm or deg of any axis, at most.
  double lever_of(std::size_t axis) {
    Derivative by_axis(d_.graph, channel(axis));
    double length = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const double speed = d_.graph[by_axis.of(steps_[i].by.nominal)].range.magnitude();
      const double reach = i < frozen_from_ ? taken_[i] : reach_mm_[i - frozen_from_];
      length += speed * (steps_[i].turn ? maths::kRadPerDeg * reach : 1);
    }
    return length;
  }

  const std::vector<AxisColumn>& columns() const { return columns_; }
  const NodeVector& deviation() const { return walk_.deviation(); }
  const Derivation& derivation() const { return d_; }
  /// The derivation, without outputs yet. Call it once.
  Derivation finish() {
    d_.columns = columns_;
    d_.deviation = walk_.deviation();
    d_.spread_mm = walk_.spread_mm();
    for (const auto& [name, part] : walk_.parts()) d_.parts.push_back({name, part, {}});
    return std::move(d_);
  }

 private:
  NodeId channel(std::size_t axis) { return translate_.channel(ChannelKind::kPosition, axis); }

  /// One beyond the last step that depends on a corrected axis.
  std::size_t end_of_motion() {
    std::size_t end = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      for (const std::size_t axis : axes_)
        if (d_.graph.depends_on(steps_[i].by.nominal, channel(axis))) end = i + 1;
    return end;
  }

  void find_columns(const Step* last_turn) {
    const NodeVector point = walk_.nominal();
    for (const std::size_t axis : axes_) {
      AxisColumn column{axis, column_of(axis, point, last_turn), length_of(axis, last_turn)};
      const bool still = std::all_of(column.direction.begin(), column.direction.end(),
                                     [&](NodeId id) { return d_.graph.is_zero(id); });
      if (!still) columns_.push_back(column);
    }
  }

  NodeVector column_of(std::size_t axis, const NodeVector& point, const Step* last_turn) {
    try {
      return motion_of(d_.graph, channel(axis), point, last_turn);
    } catch (const std::domain_error& reason) {
      throw text::InputError(
          {machine_.file, machine_.axes[axis].line}, machine_.axes[axis].name,
          std::string("the motion of this axis in the nominal chain cannot be compiled: ") + reason.what());
    }
  }

  /// Upper bound of the length of an axis' column: motions by its rotations and its shifts.
  double length_of(std::size_t axis, const Step* last_turn) {
    Derivative by_axis(d_.graph, channel(axis));
    double length = 0;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const Step& step = steps_[i];
      const double speed = d_.graph[by_axis.of(step.by.nominal)].range.magnitude();
      length += speed * (step.turn ? maths::kRadPerDeg * taken_[i] : 1);
    }
    if (last_turn == nullptr) return length;
    const double turning = maths::kRadPerDeg * d_.graph[by_axis.of(last_turn->by.nominal)].range.magnitude();
    if (turning > 0) d_.turning[axis] = turning;
    return length + turning * walk_.reach_mm();
  }

  const model::Machine& machine_;
  Derivation d_;
  Translator translate_;
  std::vector<Step> steps_;
  Walk walk_;
  std::size_t frozen_from_ = 0;
  std::vector<double> taken_, reach_mm_;  // reach of the point when each step was taken, mm: before, after
  std::vector<std::size_t> axes_;
  std::vector<AxisColumn> columns_;
};

/// Is the deviation within the span of the directions? (Tested by its terms, not by their sums.)
bool holds(const Graph& g, const Span& span, const NodeVector& deviation) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - span.basis * span.basis.transpose();
  for (std::size_t c = 0; c < 3; ++c)
    if (!g.is_zero(deviation[c]) && across.col(static_cast<Eigen::Index>(c)).norm() > 1e-9) return false;
  return true;
}

std::string names_of(const model::Machine& machine, const Derivation& d) {
  std::string names;
  for (const AxisDeviation& out : d.outputs)
    names += (names.empty() ? "" : ", ") + machine.axes[out.axis].name;
  return names;
}

/// A derivation with its outputs, and data for a second evaluation.
struct Solution {
  Derivation derivation;
  Solver solve;
  std::size_t frozen_from = 0;
  std::optional<Tilting> tilting;
};

Solution solved(const model::Machine& machine, Attempt& attempt) {
  Solution result;
  result.frozen_from = attempt.frozen_from();
  result.derivation = attempt.finish();
  Derivation& d = result.derivation;
  result.solve = solve_axes(d);
  const Span span = span_of(d, d.columns);
  if (d.least_squares && d.least_squares->nearest)
    d.notes.push_back(
        fmt::format("the directions in which the axes move the tool point depend on the pose, and a "
                    "deviation perpendicular to these directions is not corrected; axes: {}",
                    names_of(machine, d)));
  else if (span.rank < 3 && !holds(d.graph, span, d.deviation))
    d.notes.push_back(
        fmt::format("the axes do not move the tool point in every direction, and a deviation perpendicular "
                    "to their directions is not corrected; axes: {}",
                    names_of(machine, d)));
  return result;
}

/// Do the axes span the deviation in every pose?
bool spans(const Attempt& attempt, const Span& reach) {
  if (!reach.everywhere) return false;
  return reach.rank == 3 || (reach.rank > 0 && holds(attempt.derivation().graph, reach, attempt.deviation()));
}

Solution position_only(const model::Machine& machine, double neglect_mm) {
  Attempt linear(machine, neglect_mm, false);
  const Span reach = span_of(linear.derivation(), linear.columns());
  if (spans(linear, reach)) return solved(machine, linear);
  Attempt all(machine, neglect_mm, true);
  if (all.columns().empty())
    throw text::InputError({machine.file, 0}, machine.name,
                           "cannot be compiled: no axis moves the tool point");
  const Span whole = span_of(all.derivation(), all.columns());
  if (whole.rank <= reach.rank && reach.everywhere) return solved(machine, linear);
  return solved(machine, all);
}

/// Merges the contributions of the terms of the chain to the rotary axes that correct the
/// direction with the parts of the linear axes.
void merge_parts(Derivation& d, std::size_t linear_outputs) {
  const NodeId zero = d.graph.constant(0);
  const std::size_t outputs = d.outputs.size();
  for (EffectPart& part : d.parts) part.outputs.resize(outputs, zero);
  for (const EffectPart& own : d.orientation->parts) {
    auto place = std::find_if(d.parts.begin(), d.parts.end(),
                              [&](const EffectPart& part) { return part.name == own.name; });
    if (place == d.parts.end()) {
      const NodeVector none{zero, zero, zero};
      place = d.parts.insert(place, {own.name, none, std::vector<NodeId>(outputs, zero)});
    }
    for (std::size_t k = 0; k < own.outputs.size(); ++k) place->outputs[linear_outputs + k] = own.outputs[k];
  }
}

/// The smallest relevant rotation is a length at this lever, mm.
constexpr double kLever_mm = 1000;

Additions taken_back(Graph& g, const std::vector<std::size_t>& axes, const std::vector<NodeId>& values) {
  Additions added;
  for (std::size_t k = 0; k < axes.size(); ++k) added[axes[k]] = g.scale(-1, values[k]);
  return added;
}

Solution position_and_direction(const model::Machine& machine, double neglect_mm) {
  Derivation begun;
  auto tilting = solve_direction(machine, begun, neglect_mm / kLever_mm);
  if (!tilting) {
    Solution result = position_only(machine, neglect_mm);
    result.derivation.notes.push_back(
        "no rotary axis tilts the tool, so the image does not correct the direction of the tool");
    return result;
  }
  const Additions added = taken_back(begun.graph, begun.orientation->axes, begun.orientation->values);
  Attempt linear(machine, neglect_mm, false, std::move(begun), added);
  if (!spans(linear, span_of(linear.derivation(), linear.columns())))
    throw text::InputError({machine.file, 0}, "position orientation",
                           "cannot be compiled: a correction of the tool direction requires linear axes that "
                           "alone can correct the tool point");
  std::vector<AxisDeviation> rotary;
  const Orientation& o = *linear.derivation().orientation;
  for (std::size_t k = 0; k < o.axes.size(); ++k)
    rotary.push_back({o.axes[k], o.values[k], {0, 0, 0}, 0, linear.lever_of(o.axes[k])});
  Solution result = solved(machine, linear);
  Derivation& d = result.derivation;
  const std::size_t linear_outputs = d.outputs.size();
  d.outputs.insert(d.outputs.end(), rotary.begin(), rotary.end());
  d.last_direction = d.orientation->deviation;
  merge_parts(d, linear_outputs);
  result.tilting = std::move(tilting);
  return result;
}

/// The limit of a correction has this margin beyond the first-order maximum.
constexpr double kRoom = 1.25;

/// Makes the corrections so far given values, limited to their possible range.
Evaluation taken_as_given(Derivation& d) {
  Graph& g = d.graph;
  Evaluation given;
  given.neglected = std::exchange(d.neglected, {});
  const std::size_t rotary = d.orientation ? d.orientation->axes.size() : 0;
  for (std::size_t k = 0; k + rotary < d.outputs.size(); ++k) {
    const AxisDeviation& out = d.outputs[k];
    const bool first = d.before.empty();
    const double range = std::min(g[out.value].range.magnitude(), d.spread_mm * out.row_norm);
    given.range.push_back(first ? range : d.before.front().range[k]);
    given.values.push_back(held_within(g, out.value, kRoom * given.range.back()));
  }
  if (d.orientation) {
    given.orientation = d.orientation->values;
    given.neglected_direction = std::exchange(d.orientation->neglected, {});
  }
  return given;
}

/// Evaluates the direction again at the corrected position. `added` gets the new corrections of
/// its axes.
std::vector<NodeId> direction_again(const model::Machine& machine, Derivation& d, const Tilting& tilting,
                                    double neglect_mm, Additions& added) {
  Graph& g = d.graph;
  Orientation& o = *d.orientation;
  Additions all = taken_back(g, o.axes, o.values);
  all.insert(added.begin(), added.end());
  d.last_direction =
      walked(machine, d, all, tilting.frozen_from, Walk::of_direction(d, neglect_mm / kLever_mm, o.neglected))
          .deviation();
  std::vector<NodeId> turned = tilting.solve(g, d.last_direction, o.values);
  const std::size_t first = d.outputs.size() - o.axes.size();
  for (std::size_t k = 0; k < o.axes.size(); ++k) {
    o.values[k] = held_within(g, g.add(o.values[k], turned[k]), o.limit_deg[k]);
    d.outputs[first + k].value = o.values[k];
  }
  added.merge(taken_back(g, o.axes, o.values));
  return turned;
}

/// One more evaluation: the direction at the corrected position, then the point with the direction's new
/// correction.
void evaluate_again(const model::Machine& machine, Solution& so_far, double neglect_mm) {
  Derivation& d = so_far.derivation;
  Graph& g = d.graph;
  d.before.push_back(taken_as_given(d));
  const std::vector<NodeId>& values = d.before.back().values;
  std::vector<std::size_t> axes;
  for (std::size_t k = 0; k < values.size(); ++k) axes.push_back(d.outputs[k].axis);
  Additions added = taken_back(g, axes, values);
  std::vector<NodeId> turned;
  if (d.orientation) turned = direction_again(machine, d, *so_far.tilting, neglect_mm, added);
  const Walk walk = walked(machine, d, added, so_far.frozen_from, Walk(d, neglect_mm, d.neglected));
  const Solved again = so_far.solve(g, walk.deviation());
  for (std::size_t k = 0; k < values.size(); ++k) d.outputs[k].value = g.add(values[k], again.values[k]);
  if (d.least_squares) {
    d.least_squares->deviation = again.components;
    d.least_squares->weights = again.weights;
  }
  EffectPart rest{
      "evaluation " + std::to_string(d.before.size() + 1) + ", at the corrected position", {}, {}};
  rest.deviation.fill(g.constant(0));
  rest.outputs = again.values;
  rest.outputs.insert(rest.outputs.end(), turned.begin(), turned.end());
  d.parts.push_back(std::move(rest));
}

/// Neglect limit of an evaluation that is not the last. The next evaluation corrects it except for
/// the slope of the errors.
constexpr double kCoarseNeglect_mm = 1e-4;

}  // namespace

Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations) {
  check_machine(machine);
  const auto neglect_in = [&](int evaluation) {
    return evaluation < evaluations ? std::max(neglect_mm, kCoarseNeglect_mm) : neglect_mm;
  };
  Solution solution = machine.correct_orientation ? position_and_direction(machine, neglect_in(1))
                                                  : position_only(machine, neglect_in(1));
  if (solution.derivation.outputs.empty()) return std::move(solution.derivation);
  for (int i = 2; i <= evaluations; ++i) evaluate_again(machine, solution, neglect_in(i));
  return std::move(solution.derivation);
}

}  // namespace vernier::compile
