// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/part/surface/ruled_surface.h"

namespace vernier::part {

/// The two flanks of the S-shaped test part of ISO 10791-7, A and B. Control points: the programs of tables 1
/// and 2 in Chanal, Duc, Chevalier, Precision Engineering 75 (2022) 193-209. Misprints are corrected as
/// listed in tools/docs/s_part.md.
const std::array<RuledSurface, 2>& s_part();

/// Height of the part, and the heights at which the part is measured (bottom and top line), mm.
inline constexpr double kPartHeightMm = 30;
inline constexpr std::array<double, 2> kMeasuredHeightsMm = {11, 25};

}  // namespace vernier::part
