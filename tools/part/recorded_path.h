// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/part/defect.h"

namespace vernier::part {

/// Positions that a controller recorded during the cut of the part, in the order of time.
struct RecordedPath {
  std::string file;
  std::vector<JointPose> joints;
};

/// Reads the columns of the axes X Y Z B C as `vernier record` writes them; other columns are ignored.
/// `zero`: the recorded values at which the part's axis positions are 0. Throws InputError with file, line
/// and word.
RecordedPath read_recorded(const std::string& text, const std::string& file, const JointPose& zero = {});

/// Remaining material of the part after a recorded path at a point, along the normal of the surface;
/// positive: too much material.
struct RecordedPoint {
  double recorded_mm = 0;  // by the recorded positions
  double path_mm = 0;      // of the ideal path: material that a cylinder cannot cut
  std::size_t sample = 0;  // that cut it

  double controller_mm() const { return recorded_mm - path_mm; }
};

struct RecordedDeviations {
  std::string file;
  std::vector<RecordedPoint> points;
};

/// Computes for each point how far the cutter reaches in along the normal of the surface. The ray is cut with
/// the cylinder of the flank at recorded poses, and at poses on the straight path of the axes between two
/// recorded poses; the deepest cut counts. Poses are evaluated with the nominal machine: the results are
/// deviations of the positions, not of the machine. Throws InputError if no pose comes within 1 mm of a
/// point.
RecordedDeviations recorded_deviations(const BHeadMachine& machine, const RecordedPath& recorded,
                                       const std::vector<PartPoint>& points, const Cutter& cutter);

/// `file`, `points`, and of each kind of deviation the least, the largest and the rms.
nlohmann::ordered_json recorded_json(const RecordedDeviations& deviations);

/// Returns one row per point: its position, the deviations, the defect of the machine, and the sum of both.
std::string recorded_csv(const std::vector<PartPoint>& points, const PartDefect& defect,
                         const RecordedDeviations& deviations);

}  // namespace vernier::part
