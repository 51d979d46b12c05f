// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/part/identify.h"
#include "tools/part/part_path.h"
#include "tools/part/recorded_path.h"

namespace vernier::part {

/// All results of one run of the command `part s-shape`.
struct PartJob {
  BHeadMachine machine;
  DefectOptions options;
  std::vector<PartPath> paths;    // paths of both flanks
  std::vector<PartPoint> points;  // the hundred points of the standard, or the measured points
  PartDefect defect;              // defect at these points
  std::optional<MeasuredPart> measured;
  std::optional<RecordedDeviations> recorded;  // deviations at these points, from a recorded path
  std::optional<Identification> identified;
};

/// Returns the results as JSON for programs; the keys are in tools/docs/s_part.md.
nlohmann::ordered_json part_json(const PartJob& job);

/// Returns the name of a DefectReading as it is written on the command line.
const char* reading_name(DefectReading reading);

}  // namespace vernier::part
