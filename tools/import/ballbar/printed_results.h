// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/circular.h"

namespace vernier::importer {

/// A result that the file prints, and the same result computed here, both in the printed unit.
struct PrintedResult {
  std::string place;  // "CCW", "ISO230_4 1996" …
  std::string name, unit;
  double printed = 0;
  std::optional<double> computed;
  bool equal = false;  // to the last digit that the file prints
  /// Source of the result: "readings"; "model curve", the file's SIMULATION, because the fit of that curve to
  /// the readings is not published; "printed results". If `computed` is absent, `from` is empty.
  std::string from;
  std::string why;  // why it was not computed, or what may make it differ
};

/// Returns all results that a file prints: of its runs, ISO 230-4, ANSI/ASME B5.54 and B5.57, and the
/// diagnostics of its software with their ranking. If printed and computed results agree, the indices, angles
/// and definitions of the file are read correctly.
std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle);

}  // namespace vernier::importer
