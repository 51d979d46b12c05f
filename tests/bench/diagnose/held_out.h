// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "tests/support/hidden_survey.h"

namespace vernier::bench {

/// rms of the check rows after `vernier add` of a candidate and `vernier fit`, over that after a fit of the
/// model with the true term, started at the truth. Files are in `folder` (model.xml, survey.csv).
/// Nothing where a command fails; the reason is then in `why`.
std::optional<double> held_out_ratio(const support::HiddenSurvey& survey, const std::string& add,
                                     const std::string& vernier, const std::string& folder, std::string& why);

}  // namespace vernier::bench
