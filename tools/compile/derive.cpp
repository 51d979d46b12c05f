#include "tools/compile/derive.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/compile/calculus.h"
#include "tools/compile/solve.h"
#include "tools/compile/walk.h"

namespace vernier {
namespace {

constexpr double kRad = std::numbers::pi / 180;

void check_machine(const Machine& machine) {
  for (const Static& s : machine.statics)
    if (!s.hidden && !s.nominal)
      throw InputError({machine.file, s.line}, s.name,
                       "a free static without nominal cannot be compiled (fit writes it)");
  for (std::size_t i = 0; i < machine.axes.size(); ++i) axis_range(machine, i);
  if (machine.axes.size() > kMaxAxes || machine.inputs.size() > kMaxInputs)
    throw InputError({machine.file, 0}, machine.name, "more axes or inputs than an image holds");
}

/// A derivation on the way: the corrected axes are chosen between its two halves.
class Attempt {
 public:
  Attempt(const Machine& machine, double neglect_mm, bool rotary_too)
      : machine_(machine),
        translate_(machine, d_),
        steps_(all_steps(machine, translate_, d_.graph)),
        walk_(d_, neglect_mm) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      if (!machine.axes[i].rotary || rotary_too) axes_.push_back(i);
    const std::size_t end = end_of_motion();
    // The last motion, if it is a turn, is taken as one: in front of it nothing else has to be turned.
    const bool turn_last = end > 0 && steps_[end - 1].turn;
    const std::size_t frozen_from = turn_last ? end - 1 : end;
    for (std::size_t i = 0; i < frozen_from; ++i) {
      taken_.push_back(walk_.reach_mm());
      walk_.take(steps_[i]);
    }
    find_columns(turn_last ? &steps_[end - 1] : nullptr);
    walk_.freeze();
    for (std::size_t i = frozen_from; i < steps_.size(); ++i) walk_.take(steps_[i]);
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
    Graph& g = d_.graph;
    NodeVector column{};
    try {
      Derivative by_axis(g, channel(axis));
      for (std::size_t c = 0; c < 3; ++c) column[c] = by_axis.of(point[c]);
      if (last_turn == nullptr) return column;
      const NodeId speed = g.scale(kRad, by_axis.of(last_turn->by.nominal));
      const auto a = static_cast<std::size_t>((last_turn->axis + 1) % 3),
                 b = static_cast<std::size_t>((last_turn->axis + 2) % 3);
      column[a] = g.subtract(column[a], g.product(speed, point[b]));
      column[b] = g.add(column[b], g.product(speed, point[a]));
      return column;
    } catch (const std::domain_error& reason) {
      throw InputError({machine_.file, machine_.axes[axis].line}, machine_.axes[axis].name,
                       std::string("cannot be compiled: the nominal chain gives this axis ") + reason.what());
    }
  }

  /// Length of an axis' column at most: what its turns swing and its shifts carry.
  double length_of(std::size_t axis, const Step* last_turn) {
    Derivative by_axis(d_.graph, channel(axis));
    double length = 0;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const Step& step = steps_[i];
      const double speed = d_.graph[by_axis.of(step.by.nominal)].range.magnitude();
      length += speed * (step.turn ? kRad * taken_[i] : 1);
    }
    if (last_turn == nullptr) return length;
    const double turning = kRad * d_.graph[by_axis.of(last_turn->by.nominal)].range.magnitude();
    if (turning > 0) d_.turning[axis] = turning;
    return length + turning * walk_.reach_mm();
  }

  const Machine& machine_;
  Derivation d_;
  Translator translate_;
  std::vector<Step> steps_;
  Walk walk_;
  std::vector<double> taken_;  // reach of the point when each step was taken, mm
  std::vector<std::size_t> axes_;
  std::vector<AxisColumn> columns_;
};

/// Does the deviation stay within what the directions span? (Told by the terms that it has, not their sums.)
bool holds(const Graph& g, const Span& span, const NodeVector& deviation) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - span.basis * span.basis.transpose();
  for (std::size_t c = 0; c < 3; ++c)
    if (!g.is_zero(deviation[c]) && across.col(static_cast<Eigen::Index>(c)).norm() > 1e-9) return false;
  return true;
}

std::string names_of(const Machine& machine, const Derivation& d) {
  std::string names;
  for (const AxisDeviation& out : d.outputs)
    names += (names.empty() ? "" : ", ") + machine.axes[out.axis].name;
  return names;
}

Derivation solved(const Machine& machine, Attempt& attempt) {
  Derivation d = attempt.finish();
  solve_axes(d);
  const Span span = span_of(d, d.columns);
  if (span.rank < 3 && !holds(d.graph, span, d.deviation))
    d.notes.push_back("the axes " + names_of(machine, d) +
                      " do not reach every direction: what lies across them is not corrected");
  return d;
}

}  // namespace

Derivation derive(const Machine& machine, double neglect_mm) {
  check_machine(machine);
  Attempt linear(machine, neglect_mm, false);
  const Span reach = span_of(linear.derivation(), linear.columns());
  const bool spans =
      (reach.rank == 3 && reach.everywhere) ||
      (reach.rank > 0 && reach.everywhere && holds(linear.derivation().graph, reach, linear.deviation()));
  if (spans) return solved(machine, linear);
  Attempt all(machine, neglect_mm, true);
  if (all.columns().empty())
    throw InputError({machine.file, 0}, machine.name, "cannot be compiled: no axis moves the tool point");
  const Span whole = span_of(all.derivation(), all.columns());
  if (whole.rank <= reach.rank && reach.everywhere) return solved(machine, linear);
  return solved(machine, all);
}

}  // namespace vernier
