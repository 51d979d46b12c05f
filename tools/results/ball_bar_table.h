// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>

#include "tools/results/circles.h"

namespace vernier::results {

/// The diagnostics of a ball bar, those that shape the circle most first: {name, value, unit, effect_um (what
/// it does to the radius, peak to peak), share (of all effects)}. Where the bar stood (its centre) is no
/// diagnostic of the machine and is left out. Fit rows of both senses; null where one sense is missing or
/// they cannot tell the terms apart. tool.
nlohmann::ordered_json ball_bar_table(const Circle& circle, const model::Measurement& measurement);

}  // namespace vernier::results
