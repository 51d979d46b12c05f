// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/types.h"
#include "tools/diagnose/verdict.h"

namespace vernier::diagnose {

/// Level of the set of causes: the true cause is rejected at most one time in twenty. A cause is rejected if
/// the data are 20 times more likely under the best cause (Markov's inequality for a likelihood ratio).
inline constexpr double kLevelOfCauses = 0.95;

/// Returns the causes of the first step that the data do not reject, most likely first: the accepted cause,
/// its alternatives, each period that the positions do not distinguish, and the error of the instrument.
/// Empty if nothing is missing, or if no cause of the catalogue explains the residual. `answer`: with its
/// verdict.
std::vector<Cause> causes_not_rejected(const Findings& found, const Diagnosis& answer);

/// Returns the error of the instrument as a cause. kind: Cause::kind.
Cause instrument_cause(const std::string& kind, double evidence);

}  // namespace vernier::diagnose
