// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// ISO 9283:1998, 8.2 and 8.3: AT_P and RT_P, the largest at the stations.
struct PathResult {
  std::vector<PoseResult> stations;
  std::size_t accuracy_at = 0, repeatability_at = 0;  // the station of the largest
};

/// Evaluates a path that was followed in several cycles (runs). Samples are in time order and need not be at
/// the same positions. Stations are equally spaced along the commanded path of the first cycle. A cycle is
/// evaluated where its measured path crosses the plane perpendicular to the commanded path. Between samples
/// the path is linear. The ends of the path are excluded, because no sample is beyond them. Throws
/// InputError: fewer than two cycles, a path without length, a station that a cycle does not cross.
PathResult evaluate_path(const std::vector<PoseReading>& readings, std::size_t stations);

/// Reads the rows of a measurement file with columns px py pz (commanded) and x y z (measured), mm; run, u, t
/// if present. Check rows are included; a row without a reading is skipped. Throws InputError.
std::vector<PoseReading> read_pose_readings(const std::string& text, const std::string& file);

}  // namespace vernier::evaluate
