// SPDX-License-Identifier: Apache-2.0
#pragma once
// Units of the board file in those of the board.
#include "comp/quantity.h"

namespace vernier {

inline constexpr double kNmPerMm = 1e6;
inline constexpr double kCountsPerDeg = static_cast<double>(kTurnCounts) / 360;
inline constexpr double kMmPerUm = 1e-3;  // and deg of 0.001 deg
inline constexpr double kMicro = 1e6;     // inputs count in millionths of their unit

}  // namespace vernier
