// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/printed_results.h"

#include <cmath>
#include <map>

#include "tools/maths/factors.h"

namespace vernier {
namespace {

using Values = std::map<std::string, double>;

// Digits behind the point that the instrument's software prints.
double last_digit(const std::string& unit) {
  if (unit == "UT_LENGTH_MM") return 1e-4;
  return unit == "UT_ANGLE" ? 1e-5 : 1e-1;
}

Values run_values(const CircularPassResult& pass) {
  return {{"AF_CENTRE_OFFSET_A", pass.centre_a_mm},
          {"AF_CENTRE_OFFSET_B", pass.centre_b_mm},
          {"AF_BEST_RADIUS", pass.radius_mm},
          {"AF_CIRCULARITY", pass.circular_deviation_um / kUmPerMm},
          {"AF_CALCULATED_FEEDRATE", pass.feed_mm_min.value_or(NAN)}};
}

Values analysis_values(const CircularResult& circle) {
  Values values;
  for (const auto& pass : circle.passes) {
    const std::string end = pass.direction > 0 ? "_CCW" : "_CW";
    if (values.contains("AF_CIRCULAR_DEVIATION" + end)) continue;  // of the first pass in that sense
    values["AF_CIRCULAR_DEVIATION" + end] = values["AF_RADIAL_DEVIATION" + end] = pass.circular_deviation_um;
    values["AF_MAX_CIRCULAR_DEVIATION" + end] = pass.max_circular_um;
    values["AF_MIN_CIRCULAR_DEVIATION" + end] = pass.min_circular_um;
    values["AF_MAX_RADIAL_DEVIATION" + end] = pass.max_radial_um;
    values["AF_MIN_RADIAL_DEVIATION" + end] = pass.min_radial_um;
    for (const char* kind : {"CIRCULAR", "RADIAL"}) {
      values[std::string("AF_MAX_") + kind + "_DEVIATION_LOCATION" + end] = pass.max_deg;
      values[std::string("AF_MIN_") + kind + "_DEVIATION_LOCATION" + end] = pass.min_deg;
    }
  }
  if (circle.bidirectional_um) values["AF_CIRCULAR_DEVIATION_BIDIRECTIONAL"] = *circle.bidirectional_um;
  if (circle.hysteresis) {
    values["AF_CIRCULAR_HYSTERESIS"] = circle.hysteresis->um;
    values["AF_CIRCULAR_HYSTERESIS_LOCATION"] = circle.hysteresis->deg;
  }
  if (circle.non_roundness_um) {
    values["AF_NON_ROUNDNESS"] = values["AF_BIDIRECTIONAL_CIRCULAR_DEVIATION"] = *circle.non_roundness_um;
    values["AF_CENTRE_OFFSET_A"] = *circle.mean_centre_a_mm * kUmPerMm;
    values["AF_CENTRE_OFFSET_B"] = *circle.mean_centre_b_mm * kUmPerMm;
    values["AF_BEST_RADIUS"] = *circle.mean_radius_mm;
  }
  return values;
}

void compare(const std::string& place, const std::vector<BallbarFeature>& features, const Values& values,
             std::vector<PrintedResult>& results) {
  for (const auto& feature : features) {
    const auto found = values.find(feature.name);
    if (found == values.end()) continue;
    // Half a digit, and a little for the rounding of a number that lies just between two.
    const bool equal = std::abs(found->second - feature.value) <= 0.5001 * last_digit(feature.unit);
    results.push_back({place, feature.name, feature.unit, feature.value, found->second, equal});
  }
}

}  // namespace

std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle) {
  std::vector<PrintedResult> results;
  for (std::size_t i = 0; i < file.runs.size(); ++i) {
    compare(file.runs[i].label, file.runs[i].features, run_values(circle.passes[i]), results);
  }
  const Values values = analysis_values(circle);
  for (const auto& analysis : file.analyses) {
    // The diagnostics' centre and radius come from its own model of the whole test, not from a circle.
    if (analysis.name == "RENISHAW_DIAGNOSTICS") continue;
    compare(analysis.name + (analysis.version.empty() ? "" : " " + analysis.version), analysis.features,
            values, results);
  }
  return results;
}

}  // namespace vernier
