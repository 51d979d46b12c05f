// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// A joint of an arm whose place the readings of the fit do not determine completely.
struct UndeterminedJoint {
  std::string joint;                    // name of the axis, or "tool" behind the last axis
  std::vector<std::string> parameters;  // their values come from convention or prior
};

/// No axis moves this transform.
inline constexpr std::size_t kNoAxis = static_cast<std::size_t>(-1);

/// Returns the joints whose parameters the last fit did not determine: the values come from convention
/// (nearest to nominal) or from a prior. Empty if the machine was never fitted, or if its file is older than
/// the origins of the parameters. `axis_of`: for each transform of the tool branch, the index of the axis
/// that moves the transform, or kNoAxis. A transform without an axis belongs to the next joint.
std::vector<UndeterminedJoint> undetermined_joints(const model::Machine& machine,
                                                   const std::vector<std::size_t>& axis_of);

/// Returns "J6 (j6_a, j6_d), tool (t_x)", with at most four parameters for each joint.
std::string joints_text(const std::vector<UndeterminedJoint>& joints);

}  // namespace vernier::exchange
