// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "tests/support/hidden_survey.h"

namespace vernier::bench {

/// Who knows the law of the noise, and that one effect of the catalogue is hidden or none: of all candidates
/// of a diagnosis the one of the greatest likelihood under the true covariance, each with the same price for
/// its unknowns and for having been one of many. No test, no hypothesis, no instrument.
struct OracleAnswer {
  bool named = false;  // it takes more away than it costs
  bool right = false;  // ... and is the hidden one, or one column with it
};

/// Of a survey without a disturbance of the instrument. Outliers: without the rows that have one; a
/// distribution that is not normal: by its variance. Throws as the fit does.
OracleAnswer ask_oracle(const support::HiddenSurvey& survey);

/// (estimate - truth) / std of every parameter that the fit of the true model takes from the data, set-ups
/// left out: an offset of the instrument is theirs.
std::vector<double> parameter_errors(const support::HiddenSurvey& survey);

}  // namespace vernier::bench
