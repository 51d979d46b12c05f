// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns `count` additional positions of an axis between `low` and `high`, in its unit and
/// increasing. No two waves down to 1/1000 of the range are alike at these positions and the
/// positions `taken` together. Of many random sets, it takes the one whose window has the lowest
/// maximum. The result is the same for the same input. tool.
std::vector<double> uneven_positions(double low, double high, const std::vector<double>& taken,
                                     std::size_t count);

/// Advice for the next measurement, as a sentence, if the positions of the axis do not distinguish the
/// periods of `finding` from others (CandidateFinding::aliases). tool.
std::string uneven_sentence(const model::Machine& machine, const model::Measurement& measurement,
                            const diagnose::CandidateFinding& finding);

}  // namespace vernier::plan
