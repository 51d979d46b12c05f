// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/plan/plan.h"

namespace vernier::plan_test {

using namespace vernier::model;
using namespace vernier::plan;

/// A survey whose design cannot tell two effects apart, and what each of them would be.
struct Confusable {
  std::string name;
  std::string header;             // of the measurement file, without readings
  std::vector<std::string> rows;  // its cells
  std::string effects[2];         // ids
  std::string adds[2];            // the true candidates
  double amplitudes[2] = {0, 0};  // of their linear unknown
  bool by_id = true;              // the plan is asked for by ids, else by the add strings
};
std::vector<Confusable> confusable_pairs();

/// Three linear axes, free squareness and datum.
std::string model_text();
inline constexpr double kUncertaintyMm = 0.002;

/// The survey with effect `truth` (0 or 1) in the machine and white noise of kUncertaintyMm.
Measurement survey(const Confusable& pair, int truth, const Machine& machine, std::uint64_t seed);

/// Readings of rows bound to `machine`, as the true machine with noise would give them.
void read(Measurement& rows, const Machine& machine, const Confusable& pair, int truth, std::uint64_t seed);

/// As many rows as the plan has, drawn from the same offers without choosing.
Measurement random_rows(const Plan& plan, const Measurement& existing, std::uint64_t seed);

}  // namespace vernier::plan_test
