// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>

#include "tools/diagnose/diagnosis.h"

namespace vernier::results {

/// Returns reversal_note() of a parameter of a candidate, in any of the candidate's terms.
std::string reversal_note(const effects::Candidate& candidate, const fit::ParameterEstimate& parameter);

/// Returns the result of `diagnose` as JSON for programs (FORMATS section 3, and additional keys).
nlohmann::ordered_json diagnosis_json(const diagnose::Diagnosis& diagnosis,
                                      const model::Measurement& measurement);

}  // namespace vernier::results
