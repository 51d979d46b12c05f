// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/part/identify.h"
#include "tools/part/part_path.h"
#include "tools/part/recorded_path.h"

namespace vernier::part {

/// All results of one run of `part s-shape`.
struct PartJob {
  BHeadMachine machine;
  DefectOptions options;
  std::vector<PartPath> paths;    // of both flanks
  std::vector<PartPoint> points;  // the hundred, or the measured ones
  PartDefect defect;              // there
  std::optional<MeasuredPart> measured;
  std::optional<RecordedDeviations> recorded;  // there too
  std::optional<Identification> identified;
};

/// The result for programs; the keys are in tools/docs/s_part.md.
nlohmann::ordered_json part_json(const PartJob& job);

/// Returns the name of a reading as the command line writes it.
const char* reading_name(DefectReading reading);

}  // namespace vernier::part
