// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::part {

/// Returns the NC program of both flanks in the form of the paper's tables (Sinumerik 840D). Cubic B-splines
/// define the path by the curve at one height of the part, and the tool axis by the curve at another height
/// (ORICURVE). The spline spans of both curves have the lengths of the spans in the bottom curve. Heights for
/// the programs in the paper: TP5C1 0 and 30 mm; TP6C2 11 and 25 mm. `path_z_mm`, `axis_z_mm`: heights from 0
/// to 30 mm.
std::string spline_program(double path_z_mm, double axis_z_mm);

}  // namespace vernier::part
