// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace vernier::workbench {

/// Compares two images: {"same", "a" and "b": {name, fingerprint, bytes, operations, tables, lags,
/// axes[], inputs[], effects[]}, "only_a", "only_b": effects by their share names, "poses",
/// "corrections": [{axis, unit, rms, max, at: {axis: position}}] or "why_not"}. The corrections
/// are those of both equations before limits, at the same quasi-random poses of the declared
/// ranges, at rest with either approach direction, inputs within their ranges; um or mdeg. a: the
/// new image; b: the active image. Throws InputError for bytes that are not an image. tool.
nlohmann::ordered_json image_diff(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

}  // namespace vernier::workbench
