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

/// Adds the findings of the last fit to an assurance. The assurance fails if the machine was never fitted, or
/// if its fit did not converge, was not plausible or gave no improvement. All other findings of the last fit
/// are listed in the assurance as not covered.
void add_findings(text::Assurance& word, const model::Machine& machine);

/// Tests whether a fit describes its readings. A good fit must have converged, its values must be plausible,
/// it must improve the check rows (if there are any), and no reading may be missing or disturbed.
text::Assurance assurance_of(const fit::FitResult& result);

/// Tests whether the correction of the machine may run, by the rules of the safety sheet. Rules of the safety
/// sheet that cannot be evaluated from the machine file are listed as not covered.
text::Assurance assurance_of(const safety::SafetySheet& sheet, const model::Machine& machine,
                             text::AssuranceKind kind);

}  // namespace vernier::results
