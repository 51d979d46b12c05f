#include "tools/kinematics/correction.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace vernier {
namespace {

Column tilt(const Poses& actual, const Poses& nominal) {
  Column result(static_cast<Eigen::Index>(actual.rotation.size()));
  for (std::size_t i = 0; i < actual.rotation.size(); ++i) {
    const Eigen::Vector3d a = actual.rotation[i].col(2), b = nominal.rotation[i].col(2);
    result[static_cast<Eigen::Index>(i)] = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
  }
  return result;
}

}  // namespace

CorrectionResult correct(const Machine& machine, const States& states, const CorrectionOptions& options) {
  const Poses nominal = forward(nominal_machine(machine), states), actual = forward(machine, states);
  CorrectionResult result;
  result.offset.assign(machine.axes.size(), Column::Zero(static_cast<Eigen::Index>(states.count)));
  result.before = actual.position - nominal.position;
  result.tilt_before = tilt(actual, nominal);
  InverseOptions solving;
  solving.match = options.with_rotary ? Match::kDirection : Match::kPosition;
  if (!options.with_rotary) solving.axes = linear_axes(machine);
  solving.tolerance_mm = options.tolerance_mm;
  solving.tolerance_deg = options.tolerance_deg;
  solving.keep_ranges = false;  // a correction may reach a little beyond the travel that is declared
  solving.only_reachable = true;
  if (!options.with_rotary && solving.axes.empty())
    throw InputError({machine.file, 0}, "", "this machine has no linear axis: correct with its rotary axes");
  InverseResult solved = solve(machine, nominal, states, solving);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    result.offset[i] = solved.states.axis[i] - states.axis[i];
  const Poses corrected = forward(machine, solved.states);
  result.after = corrected.position - nominal.position;
  result.tilt_after = tilt(corrected, nominal);
  result.each = std::move(solved.each);
  return result;
}

}  // namespace vernier
