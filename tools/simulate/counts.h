// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "comp/quantity.h"

namespace vernier::simulate {

/// Number of counts per mm of a linear axis, and per degree of a rotary axis.
inline constexpr double kCountsPerMm = 1e6, kCountsPerDeg = static_cast<double>(kTurnCounts) / 360;

/// Returns the nearest integer, limited to a range well below 64 bits.
inline std::int64_t counts(double value) {
  constexpr double kMost = 4e18;  // below 2^62, so that the sum of two counts fits 64 bits
  return std::llround(std::clamp(value, -kMost, kMost));
}

}  // namespace vernier::simulate
