// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/correction.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tools/kinematics/jacobian.h"
#include "tools/maths/decompositions.h"

namespace vernier::kinematics {
model::Column tilt_between(const model::Poses& actual, const model::Poses& nominal) {
  model::Column result(static_cast<Eigen::Index>(actual.rotation.size()));
  for (std::size_t i = 0; i < actual.rotation.size(); ++i) {
    const Eigen::Vector3d a = actual.rotation[i].col(2), b = nominal.rotation[i].col(2);
    result[static_cast<Eigen::Index>(i)] = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
  }
  return result;
}

CorrectionResult correct(const model::Machine& machine, const model::States& states,
                         const CorrectionOptions& options) {
  const model::Poses nominal = model::forward(model::nominal_machine(machine), states),
                     actual = model::forward(machine, states);
  CorrectionResult result;
  result.offset.assign(machine.axes.size(), model::Column::Zero(static_cast<Eigen::Index>(states.count)));
  result.before = actual.position - nominal.position;
  result.tilt_before = tilt_between(actual, nominal);
  InverseOptions solving;
  solving.match = options.with_rotary ? Match::kDirection : Match::kPosition;
  if (!options.with_rotary) solving.axes = linear_axes(machine);
  solving.tolerance_mm = options.tolerance_mm;
  solving.tolerance_deg = options.tolerance_deg;
  solving.keep_ranges = false;  // a correction may exceed the declared travel slightly
  solving.only_reachable = true;
  if (!options.with_rotary && solving.axes.empty())
    throw text::InputError({machine.file, 0}, "",
                           "this machine has no linear axis; correct with all its axes: --rotary");
  InverseResult solved = solve(machine, nominal, states, solving);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    result.offset[i] = solved.states.axis[i] - states.axis[i];
  const model::Poses corrected = model::forward(machine, solved.states);
  result.after = corrected.position - nominal.position;
  result.tilt_after = tilt_between(corrected, nominal);
  result.each = std::move(solved.each);
  return result;
}

std::vector<model::Column> first_order_offset(const model::Machine& machine, const model::States& states) {
  const model::Machine nominal = model::nominal_machine(machine);
  const std::vector<std::size_t> axes = linear_axes(machine);
  const Eigen::Matrix3Xd deviation =
      model::forward(machine, states).position - model::forward(nominal, states).position;
  std::vector<model::Column> result(machine.axes.size(),
                                    model::Column::Zero(static_cast<Eigen::Index>(states.count)));
  if (axes.empty()) return result;
  const auto jacobian = axis_jacobian(nominal, states, axes, Match::kPosition, InverseOptions{}.lever_mm);
  for (std::size_t i = 0; i < states.count; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd offset = maths::least_norm(jacobian[i], -deviation.col(column));
    for (std::size_t k = 0; k < axes.size(); ++k)
      result[axes[k]][column] = offset[static_cast<Eigen::Index>(k)];
  }
  return result;
}

}  // namespace vernier::kinematics
