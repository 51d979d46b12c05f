// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier {

/// Reading of an instrument at an axis while the output of the axis had a constant code.
struct CalibrationPoint {
  std::int64_t code = 0;
  double measured = 0;  // um of a linear axis, arcsec of a rotary one; 0 is without a correction
};

/// Gain and zero of an output with their standard uncertainties, from a straight line through the points.
struct Calibration {
  double span = 0, span_std = 0;  // mm or deg that `codes` codes are
  double zero = 0, zero_std = 0;  // code at which the instrument reads 0
  bool inverted = false;          // the measured value falls as the code rises
  double residual = 0;  // rms of measured - line, with the freedom of the line taken off; um or arcsec
  double worst = 0;     // largest of them
  std::size_t points = 0;
};

/// Fits a line to the points by least squares. codes: number of codes of the whole span. Throws BoardError:
/// fewer than three points, only one code, a slope smaller than five times its uncertainty. Not real-time
/// safe. Source: JCGM 100:2008, H.3 (calibration line).
Calibration fit_calibration(const std::vector<CalibrationPoint>& points, std::int64_t codes, bool rotary);

/// Reads a file with the header "code,measured[um]" (rotary: "code,measured[arcsec]") and one point per line;
/// # begins a comment. Throws BoardError with file and line. Not real-time safe.
std::vector<CalibrationPoint> read_calibration_points(const std::string& path, bool rotary);

/// Writes the file that an output names as its `calibration`: span, zero (the nearest code) and polarity. The
/// uncertainties are written as comments for people. The file is written by write_output: as a whole or, if
/// that fails, not changed. Then BoardError is thrown. Not real-time safe.
void write_calibration(const std::string& path, const Calibration& calibration, const std::string& axis);

/// Returns a calibration as JSON: the content of write_calibration.
std::string calibration_json(const Calibration& calibration, const std::string& axis);

}  // namespace vernier
