// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/rival.h"

namespace vernier::plan {

/// Label of the planned rows: a set-up of their own.
inline constexpr const char* kPlanRun = "plan";

/// Rows of `second` behind those of `first`; both bound to the same machine, with the same columns. tool.
model::Measurement append_rows(const model::Measurement& first, const model::Measurement& second);

/// The rows that the plan extends: fit rows with every input of the two effects, at most `most` of them,
/// spread evenly. tool.
model::Measurement rows_to_build_on(const model::Measurement& all, const Drivers& drivers, std::size_t most);

/// Existing rows, followed by rows that could be measured next.
struct Offers {
  model::Measurement rows;                // bound to the machine that the measurement is bound to
  std::size_t existing = 0;               // rows [0, existing) are measured
  std::vector<std::string> not_settable;  // inputs that an alternative uses and that cannot be set (a decoy)
};

/// `count` rows drawn with low discrepancy. Poses where the tool point is read: over the declared ranges
/// (corners, edges, interior). Poses where a length about a centre or a deviation along a normal is read: the
/// recorded ones. Both approach directions; recorded motion at half, once and twice its speed; travel since
/// the reversal, time and inputs as the effects need them. Temperatures extend 5 K beyond the recorded range,
/// loads from 0 to 1.5 times the largest. Each row is a separate run, labelled kPlanRun, so that a lag has
/// reached its final value. u: the median of the existing rows. tool.
Offers offer_rows(const model::Machine& machine, const model::Measurement& existing, const Drivers& drivers,
                  std::size_t count);

}  // namespace vernier::plan
