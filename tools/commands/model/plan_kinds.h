// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/commands/judge/part_kinds.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/states.h"
#include "tools/plan/standard/positioning_test.h"

namespace vernier::commands::plan_cli {

struct PlanArguments {
  std::string machine, output, gcode, json, images, region, tool, artefact;
  std::vector<std::string> measurements, separate, effects;
  part_cli::PartSource part;
  std::size_t points = 0;
  double confidence = 0.95;
  std::optional<double> reading_um;
  double accuracy_um = 0, expected_um = 0;
  double feed_mm_min = 5000, dwell_s = 5;
  bool check = false;
  plan::PositioningTestOptions positioning;  // the member `axis` is empty if no positioning test is requested
};

/// Returns one pose of a plan as JSON: axes and approach directions.
nlohmann::ordered_json pose_json(const model::Machine& machine, const model::States& states, std::size_t row);

/// Returns the measurement rows of a plan. Readings without u beside readings with u have an estimate
/// (fit::estimate_file_noise), with a note on stderr for each.
model::Measurement rows_of_plan(const PlanArguments& arguments, const model::Machine& machine);

/// Writes the G-code program and the measurement file of a positioning test (ISO 230-2).
void run_positioning_plan(const PlanArguments& arguments);

/// Writes the next poses for the accuracy at the required locations. Throws LimitNotMet if this accuracy
/// cannot be reached.
void run_accuracy_plan(const PlanArguments& arguments);

}  // namespace vernier::commands::plan_cli
