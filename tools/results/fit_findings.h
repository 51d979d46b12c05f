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

/// [{"code", "value", "text"}]: findings of the last fit of a machine file; empty if it was never fitted.
nlohmann::ordered_json findings_json(const model::Machine& machine);

/// Puts the findings into a word of assurance: it does not hold for a machine that was never fitted, or whose
/// fit did not converge, was absurd or no gain; the others are things that it does not cover.
void add_findings(text::Assurance& word, const model::Machine& machine);

/// True if a fit describes its readings: it converged, its values are plausible, it improves the check rows
/// (if any), no reading is missing and none is disturbed.
text::Assurance assurance_of(const fit::FitResult& result);

/// Tests whether this correction may run, by the rules of the sheet. Rules that the machine file cannot
/// answer are not covered.
text::Assurance assurance_of(const safety::SafetySheet& sheet, const model::Machine& machine,
                             text::AssuranceKind kind);

}  // namespace vernier::results
