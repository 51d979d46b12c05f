// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/part/surface/ruled_surface.h"

namespace vernier::part {

/// Returns the two flanks A and B of the S-shaped test part of ISO 10791-7. The control points of the curves
/// are those of the programs in tables 1 and 2 of Chanal, Duc, Chevalier, Precision Engineering 75 (2022)
/// 193-209. Printing errors in these tables are corrected as listed in tools/docs/s_part.md.
const std::array<RuledSurface, 2>& s_part();

/// Height of the part, and the heights at which the part is measured (bottom and top line), mm.
inline constexpr double kPartHeightMm = 30;
inline constexpr std::array<double, 2> kMeasuredHeightsMm = {11, 25};

}  // namespace vernier::part
