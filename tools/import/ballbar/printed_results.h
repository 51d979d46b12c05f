// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/circular.h"

namespace vernier::importer {

/// A result that the file prints, and the same one computed here, both in the printed unit.
struct PrintedResult {
  std::string place;  // "CCW", "ISO230_4 1996" …
  std::string name, unit;
  double printed = 0;
  std::optional<double> computed;
  bool equal = false;  // to the last digit that the file prints
  /// Source of the result: "readings"; "model curve", the file's SIMULATION, because the fit of that curve to
  /// the readings is not published; "printed results". Without `computed`: empty.
  std::string from;
  std::string why;  // why it was not computed, or what may make it differ
};

/// All results that a file prints: of its runs, ISO 230-4, ANSI/ASME B5.54 and B5.57, and its software's
/// diagnostics with their ranking. That they agree proves that the file's indices, angles and definitions are
/// read as its software meant them. tool.
std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle);

}  // namespace vernier::importer
