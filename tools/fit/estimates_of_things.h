// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/fit/types.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns place, direction and radius of every thing that rows met, with standard uncertainties from the
/// readings and from the covariance of the machine.
std::vector<ThingEstimate> estimates_of_things(const FitResult& result,
                                               const model::Measurement& measurement);

}  // namespace vernier::fit
