// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/part/identify.h"
#include "tools/part/part_path.h"

namespace vernier {

/// All that one run of `part s-shape` found out.
struct PartJob {
  BHeadMachine machine;
  DefectOptions options;
  std::vector<PartPath> paths;    // of both flanks
  std::vector<PartPoint> points;  // the hundred, or the measured ones
  PartDefect defect;              // there
  std::optional<MeasuredPart> measured;
  std::optional<Identification> identified;
};

/// The result for programs; the keys are in tools/docs/s_part.md.
nlohmann::ordered_json part_json(const PartJob& job);

/// What improvement_report_html() draws: `result` is part_json() of the same job.
nlohmann::ordered_json part_report(const PartJob& job, const nlohmann::ordered_json& result);

/// "EA0Z and EA0C; EB0Z and EB0C" of a list of lists of names; "none" of an empty one.
std::string joined_groups(const nlohmann::ordered_json& groups);

/// A reading as the command line writes it.
const char* reading_name(DefectReading reading);

}  // namespace vernier
