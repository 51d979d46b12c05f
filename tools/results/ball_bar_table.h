// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>

#include "tools/results/circles.h"

namespace vernier::results {

/// Returns the diagnostics of a ball-bar test, the diagnostic with the largest effect on the circle first:
/// {name, value, unit, effect_um (effect on the radius, peak to peak), share (of all effects)}. The position
/// of the ball bar (its centre) is not an error of the machine, and is not included. The diagnostics are
/// computed from the fit rows of both directions of the circle. The function ball_bar_table() returns null
/// if one direction is missing, or if the rows cannot distinguish the terms.
nlohmann::ordered_json ball_bar_table(const Circle& circle, const model::Measurement& measurement);

}  // namespace vernier::results
