// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// Results of ISO 9283:1998, 8.2 and 8.3: AT_P and RT_P, which are the largest values at the stations.
struct PathResult {
  std::vector<PoseResult> stations;
  std::size_t accuracy_at = 0, repeatability_at = 0;  // index of the station with the largest value
};

/// Evaluates a path that a robot followed in several cycles (runs). The samples are in time order. The
/// samples need not be at the same positions in each cycle. The stations have equal distances along the
/// commanded path of the first cycle. At a station, a cycle is evaluated where its measured path crosses the
/// plane perpendicular to the commanded path. Between samples, the path is interpolated linearly. The ends
/// of the path are not evaluated, because there are no samples beyond the ends. Throws InputError if there
/// are fewer than two cycles, if the path has no length, or if a cycle does not cross a station.
PathResult evaluate_path(const std::vector<PoseReading>& readings, std::size_t stations);

/// Reads pose readings from a measurement file. The columns of the file are px py pz (commanded) and x y z
/// (measured), mm, and optionally run, u, t. Check rows are used too. A row without a reading is ignored.
/// Throws InputError if the file is not valid.
std::vector<PoseReading> read_pose_readings(const std::string& text, const std::string& file);

}  // namespace vernier::evaluate
