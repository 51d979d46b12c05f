// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/part/b_head_machine.h"
#include "tools/part/defect.h"

namespace vernier::part {

/// The path of the axes along one flank of the part, with times.
struct PartPath {
  std::size_t flank = 0;
  std::vector<double> u, t_s;
  std::vector<JointPose> joints;
  double step_mm = 0;  // longest step along the top curve
  double chord_error_mm =
      0;  // step^2 / (8 radius): error of the straight steps at the cutter (paper, section 2)
};

struct PathOptions {
  Cutter cutter;
  double step_mm = 0.5;       // longest permitted step along the top curve
  double feed_mm_min = 1000;  // feed along the top curve
  RotarySolution solution = RotarySolution::kContinuous;
};

/// Returns the path of a flank with even and sufficiently short steps of u. The time t starts at 0 and
/// follows from the feed.
PartPath part_path(const BHeadMachine& machine, std::size_t flank, const PathOptions& options);

/// Returns the path as CSV: `t[s]` and the axes of the machine (columns of a path for `vernier simulate`).
std::string path_csv(const BHeadMachine& machine, const PartPath& path);

/// Returns the path as G-code for a controller: millimetres, absolute positions, inverse-time feed (G93), one
/// G1 block per step. The positions in the G-code are those of the axes, not of the tool tip.
std::string path_gcode(const PartPath& path, const PathOptions& options);

/// Returns CSV with one row per point: flank, curve parameter, surface point (sx, sy, sz), normal, defect,
/// axis positions. The columns of this CSV include those that read_measured_part() reads.
std::string defect_csv(const std::vector<PartPoint>& points, const PartDefect& defect);

/// Returns one text for each axis that the path moves beyond its min or max: "B 17.84 deg is beyond max 15".
std::vector<std::string> beyond_limits(const BHeadMachine& machine, const PartPath& path);

/// Throws InputError if the cutter is too thick for a concave part of the flank (its centre would move
/// backwards), or if it is not longer than the flank.
void check_cutter(const RuledSurface& surface, const Cutter& cutter);

}  // namespace vernier::part
