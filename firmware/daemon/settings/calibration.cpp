// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/calibration.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "firmware/daemon/settings/board_file.h"
#include "hal/support/output_file.h"

namespace vernier {
namespace {

constexpr double kPerUnit[] = {1e3, 3600};  // um in a mm, arcsec in a degree
constexpr double kLeastSignificance = 5;    // of the slope, in its uncertainties

std::string text(const char* format, double value) {
  char room[64];
  std::snprintf(room, sizeof(room), format, value);
  return room;
}

CalibrationPoint parse_point(const std::string& line, const std::string& where) {
  char* end = nullptr;
  CalibrationPoint point;
  point.code = std::strtoll(line.c_str(), &end, 10);
  if (end == line.c_str() || *end != ',') throw BoardError{where + "no code: " + line};
  const char* const begin = end + 1;
  point.measured = std::strtod(begin, &end);
  if (end == begin || *end != '\0' || !std::isfinite(point.measured))
    throw BoardError{where + "no measured value: " + line};
  return point;
}

}  // namespace

Calibration fit_calibration(const std::vector<CalibrationPoint>& points, std::int64_t codes, bool rotary) {
  const auto n = static_cast<double>(points.size());
  if (points.size() < 3)
    throw BoardError{"calibration: fewer than three points; measure at least three codes"};
  double mean_code = 0, mean = 0, sxx = 0, sxy = 0, squares = 0;
  for (const CalibrationPoint& p : points)
    mean_code += static_cast<double>(p.code) / n, mean += p.measured / n;
  for (const CalibrationPoint& p : points) {
    const double x = static_cast<double>(p.code) - mean_code;
    sxx += x * x, sxy += x * (p.measured - mean);
  }
  if (!(sxx > 0)) throw BoardError{"calibration: all points have the same code; measure several codes"};
  const double slope = sxy / sxx;
  Calibration result;
  for (const CalibrationPoint& p : points) {
    const double off = p.measured - mean - slope * (static_cast<double>(p.code) - mean_code);
    squares += off * off;
    result.worst = std::max(result.worst, std::fabs(off));
  }
  result.residual = std::sqrt(squares / (n - 2));
  const double slope_std = result.residual / std::sqrt(sxx);
  if (!(std::fabs(slope) > kLeastSignificance * slope_std))
    throw BoardError{
        "calibration: the measured value does not depend on the code; check wiring and instrument (slope " +
        text("%.4g", slope) + " +- " + text("%.4g", slope_std) + " a code)"};
  const double to_span = static_cast<double>(codes) / kPerUnit[rotary ? 1 : 0];
  result.span = std::fabs(slope) * to_span;
  result.span_std = slope_std * to_span;
  result.zero = mean_code - mean / slope;
  // Mean and slope of a straight line are uncorrelated, so their parts add up.
  const double lever = (result.zero - mean_code) * slope_std;
  result.zero_std = std::sqrt(result.residual * result.residual / n + lever * lever) / std::fabs(slope);
  result.inverted = slope < 0;
  result.points = points.size();
  return result;
}

std::vector<CalibrationPoint> read_calibration_points(const std::string& path, bool rotary) {
  std::ifstream file(path);
  if (!file) throw BoardError{path + ": " + std::strerror(errno)};
  const std::string header = rotary ? "code,measured[arcsec]" : "code,measured[um]";
  std::vector<CalibrationPoint> points;
  bool named = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (!named && line != header) throw BoardError{where + "the header must be " + header};
    if (named) points.push_back(parse_point(line, where));
    named = true;
  }
  if (!named) throw BoardError{path + ": the header " + header + " is missing"};
  return points;
}

void write_calibration(const std::string& path, const Calibration& c, const std::string& axis) {
  const std::string content =
      "# Output of axis " + axis + ", " + std::to_string(c.points) + " points, rms of the residual " +
      text("%.4g", c.residual) + ", worst " + text("%.4g", c.worst) + " um (rotary axis: arcsec).\n" +
      "span = " + text("%.9g", c.span) + "  # +- " + text("%.3g", c.span_std) + "\n" +
      "zero = " + text("%.0f", std::round(c.zero)) + "  # " + text("%.3f", c.zero) + " +- " +
      text("%.3g", c.zero_std) + "\n" + "polarity = \"" + (c.inverted ? "inverted" : "normal") + "\"\n";
  if (const auto failed = write_output(path, content)) throw BoardError{path + ": " + failed.message()};
}

std::string calibration_json(const Calibration& c, const std::string& axis) {
  return "{\"axis\": \"" + axis + "\", \"span\": " + text("%.9g", c.span) +
         ", \"span_std\": " + text("%.9g", c.span_std) + ", \"zero\": " + text("%.9g", c.zero) +
         ", \"zero_std\": " + text("%.9g", c.zero_std) + ", \"polarity\": \"" +
         (c.inverted ? "inverted" : "normal") + "\", \"residual_rms\": " + text("%.9g", c.residual) +
         ", \"residual_max\": " + text("%.9g", c.worst) + ", \"points\": " + std::to_string(c.points) + "}\n";
}

}  // namespace vernier
