// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

namespace vernier::part {

/// Estimate from readings in Y of a gauge block on the table, at the table positions C = 0, 90, 180, 270 deg.
/// During the readings the tool is vertical, X = 0, and the tool tip is at the height of the work origin (Z =
/// L0). The four readings determine two of the location errors (second equation with the number 14 in the
/// paper, with X = 0 and Z = L0).
struct GaugeBlockEstimate {
  double ea0b_rad = 0;  // (y0 - y180) / (2 L0); negative for the readings in the paper, which prints a
                        // positive value
  double ex0b_mm = 0;   // (y270 - y90) / 2
  /// Standard uncertainties of both values for readings with a standard uncertainty of 1 mm.
  double ea0b_per_mm = 0, ex0b_per_mm = 0;
};

/// `y_mm`: readings at C = 0, 90, 180, 270 deg, workpiece coordinates. `pivot_mm`: the length L0, above 0. A
/// shift of the gauge block along Y cancels only within each pair of readings.
GaugeBlockEstimate estimate_gauge_block(const std::array<double, 4>& y_mm, double pivot_mm);

}  // namespace vernier::part
