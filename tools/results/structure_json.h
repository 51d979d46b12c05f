// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>

#include "tools/residual/structure.h"

namespace vernier::results {

/// Returns the findings about the residual as JSON, strongest first: [{observation, column, second_column,
/// shape, share_alone, share_after, p_value, rms_um, low_um, high_um, period, runs, runs_agreeing,
/// in_all_runs, alike[], sentence}]. A key that does not apply to the finding has the value null.
nlohmann::ordered_json findings_json(const residual::FailurePicture& picture);

/// Adds two keys to a result: `findings` (findings_json) and `structure` {omnibus_p, no_findings (sentence if
/// there are no findings, from rms_um and noise_um of the result), omnibus_by, chi_p, pure_error_um,
/// lack_of_fit_um, lack_of_fit_p, repeat_freedom, neighbour_error_um, tried, outliers, shares[{observation,
/// column, share_alone, share_after, p_value}], cells[{point_mm, mean_um, noise_um, count}]}.
void add_failure(nlohmann::ordered_json& result, const residual::FailurePicture& picture);

}  // namespace vernier::results
