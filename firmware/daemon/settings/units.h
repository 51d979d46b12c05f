// SPDX-License-Identifier: Apache-2.0
#pragma once
// Factors from the units of the board file to the units of the board.
#include "comp/quantity.h"

namespace vernier {

inline constexpr double kNmPerMm = 1e6;
inline constexpr double kCountsPerDeg = static_cast<double>(kTurnCounts) / 360;
inline constexpr double kMmPerUm = 1e-3;  // also deg per 0.001 deg
inline constexpr double kMicro = 1e6;     // inputs are counted in millionths of their unit

}  // namespace vernier
