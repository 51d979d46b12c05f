// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/kinematics/correction.h"

namespace vernier::results {

/// Returns {"X": 12.5, …}: the positions of the axes in the first of the states, mm or deg.
nlohmann::ordered_json axes_json(const model::Machine& machine, const model::States& states);
/// {"position_mm": [3], "rotation_deg": [3] (rotation vector), "direction": [3] (tool z axis)} of state 0.
nlohmann::ordered_json pose_json(const model::Poses& poses);
/// {"offset": {axis: …}, "left_um": [3], "tilt_left_deg", "proof": …} of state 0.
nlohmann::ordered_json correction_json(const model::Machine& machine,
                                       const kinematics::CorrectionResult& result);
/// {"converged", "fault", "axis", "iterations", "residual_mm", "residual_deg", "condition"}.
nlohmann::ordered_json inverse_json(const model::Machine& machine, const kinematics::Inverse& proof);

/// Returns 0 for a value that rounds to zero with this number of decimals, so that the output has no
/// "-0.0000".
Eigen::Vector3d without_minus_zero(const Eigen::Vector3d& values, int decimals);
/// A line for people.
void print_pose(std::FILE* out, const char* what, const model::Poses& poses);

}  // namespace vernier::results
