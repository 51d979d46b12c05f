// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns `count` additional positions of an axis between `low` and `high`, in the unit of the axis and
/// increasing. At these positions and the existing positions `taken`, two cyclic errors with different
/// periods (down to 1/1000 of the range) are never equal. Of many random sets of positions, the set is used
/// whose spectral window has the smallest maximum. Equal arguments give the same additional positions.
std::vector<double> uneven_positions(double low, double high, const std::vector<double>& taken,
                                     std::size_t count);

/// Returns a sentence with advice for the next measurement. The advice is for a cyclic error whose period the
/// positions of the axis do not distinguish from other periods (CandidateFinding::aliases).
std::string uneven_sentence(const model::Machine& machine, const model::Measurement& measurement,
                            const diagnose::CandidateFinding& finding);

}  // namespace vernier::plan
