// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/kinematics/correction.h"

namespace vernier::results {

/// Returns the positions of the axes in the first state as JSON: {"X": 12.5, …}, mm or deg.
nlohmann::ordered_json axes_json(const model::Machine& machine, const model::States& states);
/// Returns the first pose as JSON: {"position_mm": [3], "rotation_deg": [3] (rotation vector), "direction":
/// [3] (z axis of the tool)}.
nlohmann::ordered_json pose_json(const model::Poses& poses);
/// Returns the correction at the first state as JSON: {"offset": {axis: …}, "left_um": [3], "tilt_left_deg",
/// "proof": …}.
nlohmann::ordered_json correction_json(const model::Machine& machine,
                                       const kinematics::CorrectionResult& result);
/// Returns the result of an inverse solution as JSON: {"converged", "fault", "axis", "iterations",
/// "residual_mm", "residual_deg", "condition"}.
nlohmann::ordered_json inverse_json(const model::Machine& machine, const kinematics::Inverse& proof);

/// Returns values in which a number that rounds to zero with `decimals` decimals is 0, so that the output
/// contains no "-0.0000".
Eigen::Vector3d without_minus_zero(const Eigen::Vector3d& values, int decimals);
/// Prints the first pose in one line for people.
void print_pose(std::FILE* out, const char* what, const model::Poses& poses);

}  // namespace vernier::results
