// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Poses spread over where a machine works.
struct WorkPoses {
  States states;
  double extent_mm = 0;  // diagonal of the box of the nominal tool points
};

/// Poses of these ranges, one an axis (low, high; mm or deg). tool.
WorkPoses poses_over(const Machine& machine, const std::vector<std::array<double, 2>>& ranges);

/// Poses of <volume>, else of the axes' ranges (Halton sequence, the same every time), the first two its two
/// extreme corners; both senses of motion, at rest, inputs at their reference. Throws InputError for an axis
/// without a range. tool.
WorkPoses work_poses(const Machine& machine);

}  // namespace vernier::model
