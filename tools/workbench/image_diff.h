// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace vernier::workbench {

/// Returns the differences of two images: {"same", "a" and "b": {name, fingerprint, bytes, operations,
/// tables, lags, axes[], inputs[], effects[]}, "only_a", "only_b": effects by their share names, "poses",
/// "corrections": [{axis, unit, rms, max, at: {axis: position}}] or "why_not"}. The corrections are those of
/// both equations before limits, at the same quasi-random poses of the declared ranges, at rest with either
/// direction, inputs within their ranges; um or mdeg. a: the new image; b: the running image. Throws
/// InputError for data that are not an image.
nlohmann::ordered_json image_diff(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

}  // namespace vernier::workbench
