// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/maths/alignment.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// The six readings of a complete pose in one row: three of the position, mm, and three of the rotation
/// vector, deg. The three readings of the position are adjacent, and the three readings of the rotation
/// vector are adjacent.
struct SixReadings {
  std::size_t point = 0, turn = 0;  // index of the first reading of the position, and of the first reading of
                                    // the rotation
  bool of_board = false;            // true: the readings are bx by bz brx bry brz (board); false: x y z rx ry
                                    // rz
};

/// Returns the complete poses of a measurement, one for each row with six readings.
std::vector<SixReadings> complete_poses(const model::Measurement& measurement);

/// Returns the six readings of a pose as a rigid motion.
maths::RigidMotion motion_read(const model::Measurement& measurement, const SixReadings& pose);

/// Replaces each complete pose by its inverse motion. `of_board`: true selects the poses of a board
/// in the camera frame; false selects the poses of the tool.
void invert_poses(model::Measurement& measurement, bool of_board);

}  // namespace vernier::fit
