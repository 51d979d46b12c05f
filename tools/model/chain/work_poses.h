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
  double extent_mm = 0;  // diagonal of the box of the nominal tool points, mm
};

/// Returns poses in the given ranges, with one range per axis (low, high; mm or deg).
WorkPoses poses_over(const Machine& machine, const std::vector<std::array<double, 2>>& ranges);

/// Returns poses in the working volume `<volume>`, or in the ranges of the axes if the file has no volume.
/// The poses in the working volume are a Halton sequence and are equal in every call. The first two
/// poses are at the lowest and at the highest corner of the working range. The poses contain both
/// approach directions of the axes. In all poses the axes are at rest, and the inputs have their
/// reference values. Throws InputError for an axis without a range.
WorkPoses work_poses(const Machine& machine);

}  // namespace vernier::model
