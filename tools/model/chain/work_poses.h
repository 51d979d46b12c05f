// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Poses distributed over the working range of a machine.
struct WorkPoses {
  States states;
  double extent_mm = 0;  // diagonal of the box of the nominal tool points
};

/// Returns poses in these ranges, one range per axis (low, high; mm or deg).
WorkPoses poses_over(const Machine& machine, const std::vector<std::array<double, 2>>& ranges);

/// Returns poses in <volume>, else in the ranges of the axes (Halton sequence, equal in every call). The
/// first two poses are the two extreme corners. The poses contain both directions of motion. In all poses the
/// axes are at rest and inputs are at their reference. Throws InputError for an axis without a range.
WorkPoses work_poses(const Machine& machine);

}  // namespace vernier::model
