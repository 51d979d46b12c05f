// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/periods.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::model {
namespace {

constexpr double kTurn = 360;   // deg: arguments of sin, cos and tan are degrees
constexpr double kReach = 100;  // mm or deg: of an axis without min and max

/// Pairs of states with a small distance, all over the axis.
struct Slopes {
  States states;
  double step = 0;

  Slopes(const Machine& machine, std::size_t axis, const States& at) {
    constexpr std::size_t kPlaces = 32;  // over the range, at which slopes are taken
    constexpr double kStep = 1e-6;       // of the range
    const double low = machine.axes[axis].min.value_or(-kReach);
    const double high = machine.axes[axis].max.value_or(kReach);
    step = kStep * std::max(high - low, 1.0);
    states = select_states(at, std::vector<std::size_t>(2 * kPlaces, 0));
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const double x = low + (high - low) * (static_cast<double>(i) + 0.5) / kPlaces;
      states.axis[axis][static_cast<Eigen::Index>(2 * i)] = x;
      states.axis[axis][static_cast<Eigen::Index>(2 * i + 1)] = x + step;
    }
  }

  /// Returns the steepest slope of an expression over the axis, per mm or deg.
  double steepest(const Machine& machine, const Expr& expr) const {
    const Column value = evaluate(machine, expr, states);
    double most = 0;
    for (Eigen::Index i = 0; i + 1 < value.size(); i += 2)
      if (const double slope = std::abs(value[i + 1] - value[i]) / step; std::isfinite(slope))
        most = std::max(most, slope);
    return most;
  }
};

bool is_wave(const Expr& node) { return node.op == Op::kSin || node.op == Op::kCos || node.op == Op::kTan; }

/// Finds the ranges in which an expression of an axis is not straight. Its grid is finer than any
/// real feature.
class SharpStretches {
 public:
  SharpStretches(const Machine& machine, std::size_t axis, const States& at)
      : machine_(machine), axis_(axis), at_(at) {
    low_ = machine.axes[axis].min.value_or(-kReach);
    step_ = (machine.axes[axis].max.value_or(kReach) - low_) / static_cast<double>(kGaps * kSteps);
  }

  /// Adds the stretches of one expression.
  void look_at(const Expr& expr, std::vector<Detail::Sharp>& found) const {
    if (!may_be_sharp(expr) || !(step_ > 0)) return;
    constexpr std::size_t kAtATime = 16;  // gaps: 16384 states, a few megabytes
    for (std::size_t first = 0; first < kGaps; first += kAtATime) {
      const Column values = evaluate(machine_, expr, grid(first * kSteps, kAtATime * kSteps + 1));
      for (std::size_t gap = 0; gap < kAtATime; ++gap) {
        const std::size_t stride =
            straight_stride(values.segment(static_cast<Eigen::Index>(gap * kSteps), kSteps + 1));
        if (stride == kSteps) continue;
        const double from = low_ + static_cast<double>((first + gap) * kSteps) * step_;
        found.push_back({from, from + kSteps * step_, static_cast<double>(stride) * step_});
      }
    }
  }

 private:
  /// Gaps over the range, and steps of the grid in each gap: 262144 positions, 1 um for an axis of
  /// 262 mm.
  static constexpr std::size_t kGaps = 256, kSteps = 1024;
  static constexpr double kStraight = 2e-5;  // mm or deg: a fiftieth of what any machine is corrected to

  /// Does the expression depend on the axis by more than sums, products and sines? Those have
  /// their own limits. A divisor that does not change with the axis is a factor.
  bool may_be_sharp(const Expr& expr) const {
    if (any_node(expr, [](const Expr& node) { return node.op == Op::kLag; })) return false;
    return any_node(expr, [&](const Expr& node) {
      if (node.op == Op::kDivide) return of_axis(*node.args[1]);
      return node.op > Op::kDivide && !is_wave(node) && of_axis(node);
    });
  }
  bool of_axis(const Expr& expr) const { return has_symbol(expr, {SymbolKind::kAxis, axis_}); }

  States grid(std::size_t first, std::size_t count) const {
    States states = select_states(at_, std::vector<std::size_t>(count, 0));
    for (std::size_t i = 0; i < count; ++i)
      states.axis[axis_][static_cast<Eigen::Index>(i)] = low_ + static_cast<double>(first + i) * step_;
    states.direction[axis_].setConstant(1);
    return states;
  }

  /// Returns the largest part of a gap between whose points the values are straight, or 1 if no
  /// part is.
  static std::size_t straight_stride(const Column& values) {
    std::size_t stride = kSteps;
    while (stride > 1 && !is_straight(values, static_cast<Eigen::Index>(stride))) stride /= 2;
    return stride;
  }
  static bool is_straight(const Column& values, Eigen::Index stride) {
    for (Eigen::Index a = 0; a + stride < values.size(); a += stride)
      for (Eigen::Index i = 1; i < stride; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(stride);
        const double line = (1 - share) * values[a] + share * values[a + stride];
        if (std::abs(values[a + i] - line) > kStraight) return false;
      }
    return true;
  }

  const Machine& machine_;
  std::size_t axis_;
  const States& at_;
  double low_ = 0, step_ = 0;
};

}  // namespace

Detail detail_along(const Machine& machine, std::size_t axis, const States& at) {
  Detail detail{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), {}};
  const Slopes slopes(machine, axis, at);
  const SharpStretches sharp(machine, axis, at);
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const Transform& transform : *branch)
      for (std::size_t d = 0; d < transform.dof_count(); ++d) {
        sharp.look_at(*transform.dof[d], detail.sharp);
        walk(*transform.dof[d], [&](const Expr& node) {
          if (!is_wave(node)) return;
          if (const double slope = slopes.steepest(machine, *node.args[0]); slope > 0)
            detail.period = std::min(detail.period, kTurn / slope);
        });
      }
  if (const Table* table = machine.table_of(axis))
    for (std::size_t i = 1; i < table->stations.size(); ++i)
      detail.station = std::min(detail.station, table->stations[i].loc - table->stations[i - 1].loc);
  return detail;
}

}  // namespace vernier::model
