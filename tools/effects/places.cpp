// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/places.h"
#include <cmath>

#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::effects {
namespace {

const std::vector<model::Transform>& branch_of(const model::Machine& machine, bool workpiece) {
  return workpiece ? machine.workpiece : machine.tool;
}

/// Returns the value of a degree of freedom of the nominal chain, with one axis at `position` and
/// the others at rest.
double value_at(const model::Machine& nominal, const model::Expr& expr, std::size_t axis, double position) {
  model::States one = model::make_states(1, nominal);
  for (std::size_t i = 0; i < nominal.axes.size(); ++i) {
    const model::Axis& item = nominal.axes[i];
    one.axis[i][0] = item.min && item.max ? *item.min + 0.37 * (*item.max - *item.min) : 1;
  }
  one.axis[axis][0] = position;
  return model::evaluate(nominal, expr, one)[0];
}

bool names_axis(const model::Expr& expr, std::size_t axis) {
  bool found = false;
  model::walk(expr, [&](const model::Expr& node) {
    found = found ||
            (node.op == model::Op::kSymbol && node.symbol == model::Symbol{model::SymbolKind::kAxis, axis});
  });
  return found;
}

/// Returns the change of a degree of freedom per unit of an axis in the nominal chain.
double slope(const model::Machine& nominal, const model::Expr& expr, std::size_t axis) {
  if (!names_axis(expr, axis)) return 0;
  const model::Axis& item = nominal.axes[axis];
  const double middle = item.min && item.max ? 0.5 * (*item.min + *item.max) : 1;
  const double value =
      value_at(nominal, expr, axis, middle + 0.5) - value_at(nominal, expr, axis, middle - 0.5);
  return std::isfinite(value) ? value : 0;
}

}  // namespace

const model::Transform& transform_at(const model::Machine& machine, const DofPlace& place) {
  return branch_of(machine, place.workpiece).at(place.transform);
}

const char* dof_name(const model::Machine& machine, const DofPlace& place) {
  return transform_at(machine, place).dof_name(place.dof);
}

bool is_angle(const model::Machine& machine, const DofPlace& place) {
  if (transform_at(machine, place).kind == model::TransformKind::kSixDof) return place.dof >= 3;
  return place.dof == 0 || place.dof == 3;
}

std::vector<DofPlace> all_places(const model::Machine& machine) {
  std::vector<DofPlace> places;
  for (const bool workpiece : {false, true}) {
    const auto& branch = branch_of(machine, workpiece);
    for (std::size_t t = 0; t < branch.size(); ++t)
      for (std::size_t d = 0; d < branch[t].dof_count(); ++d) places.push_back({workpiece, t, d});
  }
  return places;
}

AxisPlaces::AxisPlaces(const model::Machine& machine) {
  const model::Machine nominal = model::nominal_machine(machine);
  const std::vector<DofPlace> places = all_places(nominal);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    std::optional<DofPlace> best;
    double most = 0;
    double largest = 0.01;  // an axis moves its own degree of freedom one to one; errors are far smaller
    for (const DofPlace& place : places) {
      const double change = slope(nominal, *transform_at(nominal, place).dof[place.dof], axis);
      if (std::abs(change) <= largest * 1.01) continue;
      largest = std::abs(change);
      most = change;
      best = place;
    }
    own_.push_back(best);
    sense_.push_back(!best ? 0 : most < 0 ? -1 : 1);
  }
}

std::optional<std::size_t> AxisPlaces::axis_of(const DofPlace& place) const {
  for (std::size_t axis = 0; axis < own_.size(); ++axis)
    if (own_[axis] && own_[axis]->workpiece == place.workpiece && own_[axis]->transform == place.transform)
      return axis;
  return std::nullopt;
}

std::vector<DofPlace> carrier_places(const model::Machine& machine) {
  std::vector<DofPlace> places;
  const auto take = [&](bool workpiece, std::size_t at) {
    const std::size_t count = branch_of(machine, workpiece)[at].dof_count();
    for (std::size_t d = 0; d < count; ++d) places.push_back({workpiece, at, d});
  };
  const auto &tool = machine.tool, &workpiece = machine.workpiece;
  if (!tool.empty()) take(false, 0);
  if (tool.size() > 1 && is_stand_in(machine, {false, 0, 0})) take(false, 1);
  if (!workpiece.empty()) take(true, workpiece.size() - 1);
  if (workpiece.size() > 1 && is_stand_in(machine, {true, workpiece.size() - 1, 0}))
    take(true, workpiece.size() - 2);
  return places;
}

bool is_stand_in(const model::Machine& machine, const DofPlace& place) {
  return transform_at(machine, place).line == 0;
}

model::Machine with_base_row(model::Machine machine) {
  const bool workpiece = !machine.workpiece.empty();
  std::vector<model::Transform>& branch = workpiece ? machine.workpiece : machine.tool;
  if (branch.empty() || !base_places(machine).empty()) return machine;
  model::Transform row;
  row.line = 0;  // not in the file
  row.n = workpiece ? branch.back().n + 1 : branch.front().n - 1;
  for (std::size_t d = 0; d < row.dof_count(); ++d) {
    row.text[d] = "0";
    row.dof[d] = model::parse_expression(row.text[d]);
  }
  branch.insert(workpiece ? branch.end() : branch.begin(), row);
  return machine;
}

std::vector<DofPlace> base_places(const model::Machine& machine) {
  const bool workpiece = !machine.workpiece.empty();
  const auto& branch = branch_of(machine, workpiece);
  if (branch.empty()) return {};
  const std::size_t at = workpiece ? branch.size() - 1 : 0;
  if (branch[at].kind != model::TransformKind::kSixDof) return {};
  if (workpiece) {
    // The lengths act before the angles of the same transform. With a rotary table they are no
    // base shift.
    const model::Machine nominal = model::nominal_machine(machine);
    for (std::size_t d = 3; d < 6; ++d) {
      const model::Expr& expr = *nominal.workpiece[at].dof[d];
      for (std::size_t axis = 0; axis < machine.axes.size(); ++axis)
        if (names_axis(expr, axis) || value_at(nominal, expr, axis, 0) != 0) return {};
    }
  }
  return {{workpiece, at, 0}, {workpiece, at, 1}, {workpiece, at, 2}};
}

}  // namespace vernier::effects
