// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/safety/safety_sheet.h"

namespace vernier::results {

/// Returns the rules of the safety sheet for which the machine file has a number: [{"rule":…, "value":…,
/// "limit":…, "unit":…, "ok":…, "accepted":…, "culprit":…, "reason":…}…]. The other rules of the safety sheet
/// are in `not_covered` of the assurance.
nlohmann::ordered_json safe_to_run_json(const safety::SafetySheet& sheet);

/// Returns all rules of the safety sheet as JSON for the workbench page. The value of a rule is null if the
/// machine file contains no number for the rule.
nlohmann::ordered_json safety_json(const safety::SafetySheet& sheet);

/// Returns the safety sheet as text for users, one line for each rule.
void print_safety(std::FILE* out, const safety::SafetySheet& sheet);

}  // namespace vernier::results
