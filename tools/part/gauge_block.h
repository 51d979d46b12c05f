// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

namespace vernier::part {

/// Readings in Y of a gauge block on the table at table positions C = 0, 90, 180, 270 deg. The tool is
/// vertical, X = 0, and the tip is at the height of the work origin (Z = L0). Four readings give two of the
/// location errors (equation 14 of the paper, the second of that number, with X = 0 and Z = L0).
struct GaugeBlockEstimate {
  double ea0b_rad = 0;  // (y0 - y180) / (2 L0); negative for the paper's readings, which prints it positive
  double ex0b_mm = 0;   // (y270 - y90) / 2
  /// Standard uncertainties for readings with standard uncertainty 1 mm.
  double ea0b_per_mm = 0, ex0b_per_mm = 0;
};

/// y_mm: readings at C = 0, 90, 180, 270 deg, workpiece coordinates. pivot_mm: L0, above 0. A shift of the
/// block along Y cancels only within each pair.
GaugeBlockEstimate estimate_gauge_block(const std::array<double, 4>& y_mm, double pivot_mm);

}  // namespace vernier::part
