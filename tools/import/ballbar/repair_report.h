// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/import/ballbar/repeating_error.h"
#include "tools/import/ballbar/time_repair.h"

namespace vernier::importer {

/// A ball-bar file with a repaired time base, and its repeating error before and after the repair.
struct RepairReport {
  TimeRepair repair;
  std::vector<RepeatingError> before,
      after;  // one entry per repaired run; before: with the angles of the file; after: with the repaired
              // angles
};

/// Repairs the time base of a file. After the repair, the function fits the repeating error of each repaired
/// run, on the same samples before and after the repair.
RepairReport repair_and_judge(const BallbarFile& file);

/// Writes the changes by a repair and the reduction of the error: repair_json for programs, print_repair for
/// people.
nlohmann::ordered_json repair_json(const RepairReport& report);
void print_repair(std::FILE* out, const RepairReport& report);

}  // namespace vernier::importer
