// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>

namespace vernier::model {

/// Standard uncertainty of a reading that grows with the length from the instrument. The data sheet of a
/// tracker, a distance meter or a coordinate measuring machine states it.
struct ReadingUncertainty {
  double constant_mm = 0, per_mm = 0;
  std::array<double, 3> at{0, 0, 0};  // position of the instrument in the measuring frame, mm

  double of_length(double length_mm) const { return constant_mm + per_mm * length_mm; }
};

/// Parses "15um + 6um/m", or the form of ISO 10360-2 "2.5 + L/300" (um; L in mm). The terms are
/// joined by +. Each term is a length, a length per metre, or L/K. Throws InputError with the
/// offending word.
ReadingUncertainty parse_reading_uncertainty(const std::string& text);

}  // namespace vernier::model
