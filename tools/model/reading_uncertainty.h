// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>

namespace vernier::model {

/// Standard uncertainty of a length reading that increases with the distance from the instrument. Data sheets
/// of laser trackers, distance meters and coordinate measuring machines state this uncertainty.
struct ReadingUncertainty {
  double constant_mm = 0, per_mm = 0;
  std::array<double, 3> at{0, 0, 0};  // position of the instrument in the measuring frame, mm

  double of_length(double length_mm) const { return constant_mm + per_mm * length_mm; }
};

/// Parses an uncertainty in the form "15um + 6um/m", or in the form of ISO 10360-2 "2.5 + L/300" (um; L in
/// mm). The character + separates the terms of the text. Each term is a length, a length per metre, or L/K (K
/// a number). If the text is not valid, throws InputError with the wrong word.
ReadingUncertainty parse_reading_uncertainty(const std::string& text);

}  // namespace vernier::model
