// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns `count` more positions of an axis between `low` and `high`, in its unit and increasing. At these
/// positions together with the existing positions `taken`, two different cyclic errors with periods down to
/// 1/1000 of the range are never equal. The function uses the best of many random sets: the set whose window
/// has the smallest largest peak. The result is equal for equal input.
std::vector<double> uneven_positions(double low, double high, const std::vector<double>& taken,
                                     std::size_t count);

/// Returns advice for the next measurement, as a sentence, if the positions of the axis do not distinguish
/// the periods of `finding` from other periods (CandidateFinding::aliases).
std::string uneven_sentence(const model::Machine& machine, const model::Measurement& measurement,
                            const diagnose::CandidateFinding& finding);

}  // namespace vernier::plan
