// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/maths/alignment.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// The six readings of a complete pose of one row: three of the position, mm, and three of the rotation
/// vector, deg. The three readings of each are adjacent.
struct SixReadings {
  std::size_t point = 0, turn = 0;  // index of the first reading of the position and of the rotation
  bool of_board = false;            // bx by bz brx bry brz; else x y z rx ry rz
};

/// Returns the complete poses, one for each row that has one.
std::vector<SixReadings> complete_poses(const model::Measurement& measurement);

/// Returns the values of six readings as a motion.
maths::RigidMotion motion_read(const model::Measurement& measurement, const SixReadings& pose);

/// Replaces each complete pose of a kind by its inverse.
void invert_poses(model::Measurement& measurement, bool of_board);

}  // namespace vernier::fit
