// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/fit/types.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns position, direction and radius of every touched object (unknown point or artefact). The standard
/// uncertainties of the estimates come from the readings and from the covariance of the machine.
std::vector<ThingEstimate> estimates_of_things(const FitResult& result,
                                               const model::Measurement& measurement);

}  // namespace vernier::fit
