// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/map/field.h"

namespace vernier::results {

/// Returns an error field as JSON for the reports and for programs: {axes[], counts[], max_um, rms_um,
/// max_at_mm[3], point_mm[][3], deviation_um[][3]}.
nlohmann::ordered_json field_json(const model::Machine& machine, const map::ErrorField& field);

/// Returns a state in which each linear axis is at the middle of its range, inputs have their reference
/// values, and all other values are 0. The values in the user's `words` then replace these values (as for
/// state_at). Throws InputError with the wrong word if `words` are not valid.
model::States middle_state(const model::Machine& machine, const std::string& words);

/// Returns field_json over the linear axes, with `count` nodes along each axis, starting from middle_state.
/// The function volume_json() returns nullopt if the machine has no such volume (no linear axis, more than
/// three, or a linear axis without min and max). If there is no result, `why_not` contains the reason.
std::optional<nlohmann::ordered_json> volume_json(const model::Machine& machine, std::size_t count,
                                                  std::string& why_not);

}  // namespace vernier::results
