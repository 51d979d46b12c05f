// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/circular.h"

namespace vernier::importer {

/// Commanded position of the machine at the time of one reading, on a circle at constant speed.
struct CirclePoint {
  double angle_deg = 0;              // angle from +A towards +B, 0..360
  double position_mm[2] = {0, 0};    // position along A and B, relative to the programmed centre
  double velocity_mm_s[2] = {0, 0};  // velocity along A and B
  double acceleration_mm_s2[2] = {0, 0};
  int direction[2] = {0, 0};    // direction of the last motion, -1 or +1
  double since_mm[2] = {0, 0};  // travel of the axis since its last reversal
};

/// Returns the actual feed of a run from the number of samples on its arc, mm/min.
double actual_feed_mm_min(const BallbarFile& file, const BallbarRun& run);

/// Returns the commanded motion at sample `index` of a run. Outside the arc start..end, the angle continues
/// at the same speed.
CirclePoint circle_point(const BallbarFile& file, const BallbarRun& run, std::size_t index);

/// Returns the analysed arcs (start..end) of all runs, for analyse_circle.
std::vector<CircularPass> circular_passes(const BallbarFile& file);

}  // namespace vernier::importer
