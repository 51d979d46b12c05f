// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/assurance.h"

namespace vernier::results {

/// Returns the findings of the last fit of a machine file as [{"code", "value", "text"}]; empty if the
/// machine was never fitted.
nlohmann::ordered_json findings_json(const model::Machine& machine);

/// Adds the findings to an assurance. The assurance fails for a machine that was never fitted, or whose fit
/// did not converge, was absurd or gave no gain; other findings are listed as not covered.
void add_findings(text::Assurance& word, const model::Machine& machine);

/// Tests whether a fit describes its readings: it converged, its values are plausible, it improves the check
/// rows (if any), no reading is missing and no reading is disturbed.
text::Assurance assurance_of(const fit::FitResult& result);

/// Tests whether the correction of the machine may run, by the rules of the sheet. Rules that cannot be
/// evaluated from the machine file are listed as not covered.
text::Assurance assurance_of(const safety::SafetySheet& sheet, const model::Machine& machine,
                             text::AssuranceKind kind);

}  // namespace vernier::results
