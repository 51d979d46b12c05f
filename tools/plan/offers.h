// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/hypothesis.h"

namespace vernier::plan {

/// Run label of the planned rows, which have a separate set-up.
inline constexpr const char* kPlanRun = "plan";

/// Returns the rows of `first`, followed by the rows of `second`. The measurements `first` and `second` must
/// belong to the same machine and must have the same columns.
model::Measurement append_rows(const model::Measurement& first, const model::Measurement& second);

/// Returns the existing rows on which the plan is based: at most `most` fit rows with every input of the two
/// effects, evenly distributed.
model::Measurement rows_to_build_on(const model::Measurement& all, const Drivers& drivers, std::size_t most);

/// The rows of the existing measurement, followed by rows that could be measured next.
struct Offers {
  model::Measurement rows;                // rows in the form that the machine of the measurement requires
  std::size_t existing = 0;               // number of existing rows: the rows [0, existing) are measured
  std::vector<std::string> not_settable;  // inputs that an alternative uses and that the user cannot set
                                          // (because the cause is false)
};

/// Returns `count` random rows that could be measured next, with low discrepancy. If the readings are of the
/// tool point, the poses are in the declared ranges (corners, edges, interior). If the readings are lengths
/// about a centre or deviations along a normal, the poses are the recorded poses. The offered rows contain
/// both approach directions. A recorded motion is offered with half, once and twice its speed. The travel
/// since the reversal, the time and the inputs have the values that distinguish the effects. Temperatures
/// extend 5 K beyond the recorded range. Loads are from 0 to 1.5 times the largest recorded load. Each
/// offered row is a separate run with the label kPlanRun, so that a lag has reached its final value. The
/// standard uncertainty u of the offered rows is the median of the existing rows.
Offers offer_rows(const model::Machine& machine, const model::Measurement& existing, const Drivers& drivers,
                  std::size_t count);

}  // namespace vernier::plan
