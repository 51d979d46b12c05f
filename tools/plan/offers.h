// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/rival.h"

namespace vernier::plan {

/// Label of the planned rows: the plan has a separate set-up.
inline constexpr const char* kPlanRun = "plan";

/// Returns the rows of `first`, followed by those of `second`. Both measurements must be bound to the same
/// machine and have the same columns.
model::Measurement append_rows(const model::Measurement& first, const model::Measurement& second);

/// Returns the rows that the plan extends: fit rows with every input of the two effects, at most
/// `most` of them, evenly distributed.
model::Measurement rows_to_build_on(const model::Measurement& all, const Drivers& drivers, std::size_t most);

/// Existing rows, followed by rows that could be measured next.
struct Offers {
  model::Measurement rows;   // bound to the machine of the measurement
  std::size_t existing = 0;  // rows [0, existing) are measured
  std::vector<std::string>
      not_settable;  // inputs that an alternative uses and that cannot be set (a false cause)
};

/// Returns `count` random rows with low discrepancy. If the tool point is read, the poses are in the declared
/// ranges (corners, edges, interior). If a length about a centre or a deviation along a normal is read, the
/// poses are the recorded poses. The offered rows contain both approach directions. Recorded motion is
/// offered at half, once and twice its speed. Travel since the reversal, time and inputs are as the effects
/// need them. Temperatures extend 5 K beyond the recorded range, loads from 0 to 1.5 times the largest. Each
/// offered row is a separate run, labelled kPlanRun, so that a lag has reached its final value. u: the median
/// of the existing rows.
Offers offer_rows(const model::Machine& machine, const model::Measurement& existing, const Drivers& drivers,
                  std::size_t count);

}  // namespace vernier::plan
