// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// `count` more positions of an axis between `low` and `high`, in its unit and increasing. No two cyclic
/// errors with periods down to 1/1000 of the range look alike at these positions and at the positions `taken`
/// together. The best of many random sets is used: its window has the smallest largest peak. The result is
/// the same for the same input. tool.
std::vector<double> uneven_positions(double low, double high, const std::vector<double>& taken,
                                     std::size_t count);

/// Advice for the next measurement, as a sentence, if the positions of the axis do not distinguish the
/// periods of `finding` from others (CandidateFinding::aliases). tool.
std::string uneven_sentence(const model::Machine& machine, const model::Measurement& measurement,
                            const diagnose::CandidateFinding& finding);

}  // namespace vernier::plan
