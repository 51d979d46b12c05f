// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/safety/safety_sheet.h"

namespace vernier::results {

/// Returns the safety sheet as JSON: [{"rule":…, "value":…, "limit":…, "unit":…, "ok":…, "accepted":…,
/// "culprit":…, "reason":…}…]; value is null if the file does not give it.
nlohmann::ordered_json safety_json(const safety::SafetySheet& sheet);

/// Returns the safety sheet as text for users, one line for each rule.
void print_safety(std::FILE* out, const safety::SafetySheet& sheet);

}  // namespace vernier::results
