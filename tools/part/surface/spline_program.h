// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::part {

/// Returns the program of both flanks as the paper's tables print it (Sinumerik 840D). The path is given by
/// cubic B-splines of the curve at one height of the part, the tool's axis by those at another height
/// (ORICURVE). Spans are as long as those of the bottom curve. TP5C1: 0 and 30 mm; TP6C2: 11 and 25 mm.
/// Heights: 0 to 30 mm.
std::string spline_program(double path_z_mm, double axis_z_mm);

}  // namespace vernier::part
