// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/periods.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/model/chain.h"
#include "tools/model/evaluate.h"

namespace vernier::model {
namespace {

constexpr double kTurn = 360;   // deg: arguments of sin, cos and tan are degrees
constexpr double kReach = 100;  // mm or deg, of an axis without min and max

/// Pairs of states a small step apart, all over the axis.
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

  /// The steepest slope of an expression over the axis, per mm or deg.
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

}  // namespace

Detail detail_along(const Machine& machine, std::size_t axis, const States& at) {
  Detail detail{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const Slopes slopes(machine, axis, at);
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const Transform& transform : *branch)
      for (std::size_t d = 0; d < transform.dof_count(); ++d)
        walk(*transform.dof[d], [&](const Expr& node) {
          if (!is_wave(node)) return;
          if (const double slope = slopes.steepest(machine, *node.args[0]); slope > 0)
            detail.period = std::min(detail.period, kTurn / slope);
        });
  if (const Table* table = machine.table_of(axis))
    for (std::size_t i = 1; i < table->stations.size(); ++i)
      detail.station = std::min(detail.station, table->stations[i].loc - table->stations[i - 1].loc);
  return detail;
}

}  // namespace vernier::model
