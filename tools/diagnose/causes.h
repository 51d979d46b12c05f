// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/findings.h"
#include "tools/diagnose/types.h"

namespace vernier::diagnose {

/// Confidence level of the set of possible causes: the set excludes the true cause at most one time in
/// twenty. A cause is rejected if the data are 20 times more likely under the best cause (Markov's inequality
/// for a likelihood ratio).
inline constexpr double kLevelOfCauses = 0.95;

/// Returns the possible causes of the first step of the stepwise model that the data do not reject, most
/// likely first. The list contains the accepted cause, its alternatives, each period that the positions do
/// not distinguish, and the error of the instrument. The list of causes is empty if no effect is missing, or
/// if no cause of the catalogue explains the residual. `answer`: a diagnosis whose verdict is set.
std::vector<Cause> causes_not_rejected(const Findings& found, const Diagnosis& answer);

/// Returns the possible causes of the accepted effect at one position of the stepwise model, most likely
/// first.
std::vector<Cause> causes_of_step(const Findings& found, std::size_t position);

/// Returns the error of the instrument as a cause. `kind`: a value of Cause::kind.
Cause instrument_cause(const std::string& kind, double evidence);

/// Names of the same effect at other axes with the columns of the accepted effect at this position, where an
/// effect of both axes has these columns too: the readings show only the difference of the two axes.
std::vector<std::string> of_other_axes(const Findings& found, std::size_t position);

}  // namespace vernier::diagnose
