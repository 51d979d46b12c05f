// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace vernier::workbench {

/// Returns the differences of two correction images as JSON: {"same", "a" and "b": {name, fingerprint, bytes,
/// operations, tables, lags, axes[], inputs[], effects[]}, "only_a", "only_b": effects by their share names,
/// "poses", "corrections": [{axis, unit, rms, max, at: {axis: position}}] or "why_not"}. The corrections of
/// both images are compared before the limits are applied, in um or mdeg. The poses are quasi-random in the
/// declared ranges, at rest with both approach directions, with inputs within their ranges. `a`: the new
/// image; `b`: the image that a board executes. Throws InputError if the data are not an image.
nlohmann::ordered_json image_diff(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

}  // namespace vernier::workbench
