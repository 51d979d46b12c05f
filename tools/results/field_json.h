// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/map/field.h"

namespace vernier::results {

/// Returns an error field as the reports draw it and programs read it: {axes[], counts[], max_um, rms_um,
/// max_at_mm[3], point_mm[][3], deviation_um[][3]}.
nlohmann::ordered_json field_json(const model::Machine& machine, const map::ErrorField& field);

/// Returns a state with each linear axis at the middle of its range, inputs at their reference, all other
/// values 0; then the user's `words` are applied (as for state_at). Throws InputError with the word.
model::States middle_state(const model::Machine& machine, const std::string& words);

/// field_json over the linear axes, `count` nodes along each, from middle_state. `nullopt` if the machine has
/// no such volume (no linear axis, more than three, one without min and max); `why_not` then contains the
/// reason.
std::optional<nlohmann::ordered_json> volume_json(const model::Machine& machine, std::size_t count,
                                                  std::string& why_not);

}  // namespace vernier::results
