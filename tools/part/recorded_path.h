// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/part/defect.h"

namespace vernier::part {

/// Axis positions that a controller recorded while the part was cut, in time order.
struct RecordedPath {
  std::string file;
  std::vector<JointPose> joints;
};

/// Reads the columns of the axes X Y Z B C in the format of `vernier record`; other columns are ignored.
/// `zero`: the recorded values that correspond to the axis positions 0 of the part. If the file is not valid,
/// throws InputError with file, line and word.
RecordedPath read_recorded(const std::string& text, const std::string& file, const JointPose& zero = {});

/// Material that remains at a point of the part after a recorded path, along the normal of the surface. A
/// positive value is too much material.
struct RecordedPoint {
  double recorded_mm = 0;  // material that remains with the recorded positions
  double path_mm = 0;      // material that remains with the ideal path, because a cylinder cannot cut it
  std::size_t sample = 0;  // index of the recorded sample that cut the point

  double controller_mm() const { return recorded_mm - path_mm; }
};

struct RecordedDeviations {
  std::string file;
  std::vector<RecordedPoint> points;
};

/// Computes for each point how deep the cutter cuts along the normal of the surface. The ray along the normal
/// is intersected with the cylinder of the cutter. The cylinder is at the recorded poses and at poses on the
/// straight path of the axes between them; the deepest cut counts. The poses are evaluated with the nominal
/// machine. The results are therefore deviations of the recorded positions, not errors of the machine. Throws
/// InputError if no pose is within 1 mm of a point.
RecordedDeviations recorded_deviations(const BHeadMachine& machine, const RecordedPath& recorded,
                                       const std::vector<PartPoint>& points, const Cutter& cutter);

/// Returns JSON with `file`, `points`, and for each kind of deviation the smallest value, the largest value
/// and the rms.
nlohmann::ordered_json recorded_json(const RecordedDeviations& deviations);

/// Returns CSV with one row per point: its position, the deviations, the defect of the machine, and the sum
/// of both.
std::string recorded_csv(const std::vector<PartPoint>& points, const PartDefect& defect,
                         const RecordedDeviations& deviations);

}  // namespace vernier::part
