// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier {

/// A calibration point of an analogue output: reading of an instrument at the axis while the output has a
/// constant code.
struct CalibrationPoint {
  std::int64_t code = 0;
  double measured = 0;  // reading of the instrument: um for a linear axis, arcsec for a rotary axis; 0
                        // without a correction
};

/// Gain and zero of an analogue output with their standard uncertainties, from a straight line through the
/// calibration points.
struct Calibration {
  double span = 0, span_std = 0;  // change in mm or deg for the number `codes` of codes
  double zero = 0, zero_std = 0;  // code at which the instrument reads 0
  bool inverted = false;          // true: the measured value decreases as the code increases
  double residual = 0;  // rms difference between reading and line, corrected for the degrees of freedom of
                        // the line; um or arcsec
  double worst = 0;     // largest difference between reading and line
  std::size_t points = 0;
};

/// Fits a straight line to the calibration points by least squares. `codes`: number of codes of the whole
/// span. Throws BoardError if there are fewer than three points, if all points have one code, or if the slope
/// is smaller than five times its uncertainty. Not real-time safe. The method is that of JCGM 100:2008, H.3
/// (calibration line).
Calibration fit_calibration(const std::vector<CalibrationPoint>& points, std::int64_t codes, bool rotary);

/// Reads a file with the header "code,measured[um]" (rotary axis: "code,measured[arcsec]") and one point per
/// line. The character # begins a comment. If the file is not valid, throws BoardError with file and line.
/// Not real-time safe.
std::vector<CalibrationPoint> read_calibration_points(const std::string& path, bool rotary);

/// Writes the file for the setting `calibration` of an output: span, zero (the nearest code) and polarity.
/// The file contains the uncertainties as comments for people. If the file cannot be written completely, it
/// is not changed, and the function throws BoardError. Not real-time safe.
void write_calibration(const std::string& path, const Calibration& calibration, const std::string& axis);

/// Returns a calibration as JSON, with the content of write_calibration.
std::string calibration_json(const Calibration& calibration, const std::string& axis);

}  // namespace vernier
