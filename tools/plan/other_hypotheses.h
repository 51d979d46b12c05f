// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/plan/hypothesis.h"

namespace vernier::plan {

/// Finds other causes that explain the rows nearly as well as the best candidate. A diagnosis also considers
/// these other causes. The rows that separate the two named effects should also separate these other causes.
/// The result of find_other_hypotheses() has one cause for each combination of effect, driving axis and
/// input, best first, at most `most` causes. The two named effects are not in the result.
std::vector<FittedHypothesis> find_other_hypotheses(const effects::MachineText& model,
                                                    const model::Measurement& measurement,
                                                    const std::vector<const FittedHypothesis*>& named,
                                                    const std::vector<effects::Effect>& effects,
                                                    std::size_t most);

}  // namespace vernier::plan
