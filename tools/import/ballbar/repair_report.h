// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/import/ballbar/repeating_error.h"
#include "tools/import/ballbar/time_repair.h"

namespace vernier::importer {

/// A repaired file and its repeating error, before and after the repair.
struct RepairReport {
  TimeRepair repair;
  std::vector<RepeatingError> before,
      after;  // one per repaired run: by the file's angles, by the repaired angles
};

/// Repairs a file and fits the repeating error of each repaired run, on the same samples before and after.
RepairReport repair_and_judge(const BallbarFile& file);

/// Returns the changes by a repair and their gain: repair_json for programs, print_repair for people.
nlohmann::ordered_json repair_json(const RepairReport& report);
void print_repair(std::FILE* out, const RepairReport& report);

}  // namespace vernier::importer
