// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/circular.h"

namespace vernier::importer {

/// A result that is printed in the file of the instrument, and the same result computed by this program, both
/// in the printed unit.
struct PrintedResult {
  std::string place;  // group of the result: "CCW", "ISO230_4 1996" …
  std::string name, unit;
  double printed = 0;
  std::optional<double> computed;
  bool equal = false;  // true: printed and computed result are equal to the last printed digit
  /// Source of the computed result: "readings", "model curve" or "printed results". The model curve is the
  /// SIMULATION of the file; the method that fits it to the readings is not published. If `computed` is
  /// absent, `from` is empty.
  std::string from;
  std::string why;  // reason why the result was not computed, or why it may differ from the printed result
};

/// Returns all results that a ball-bar file prints: those of its runs, of ISO 230-4, of ANSI/ASME B5.54 and
/// B5.57, and the diagnostics of its software with their ranking. If the printed and the computed results
/// agree, the program reads the indices, angles and definitions of the file correctly.
std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle);

}  // namespace vernier::importer
