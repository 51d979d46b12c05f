// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/printed_results.h"

#include <cmath>

#include "tools/import/ballbar/printed_diagnostics.h"
#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

// Of one unit in the last digit that the instrument's software prints.
double last_digit(const std::string& unit) {
  if (unit == "UT_LENGTH_MM") return 1e-4;
  if (unit == "UT_ANGLE") return 1e-5;
  if (unit == "UT_SERVO_MISMATCH") return 1e-2;
  return unit == "UT_PERCENT" || unit == "UT_RANKING" ? 1 : 1e-1;
}

using Values = std::map<std::string, double>;

Values run_values(const CircularPassResult& pass) {
  return {{"AF_CENTRE_OFFSET_A", pass.centre_a_mm},
          {"AF_CENTRE_OFFSET_B", pass.centre_b_mm},
          {"AF_BEST_RADIUS", pass.radius_mm},
          {"AF_CIRCULARITY", pass.circular_deviation_um / maths::kUmPerMm},
          {"AF_CALCULATED_FEEDRATE", pass.feed_mm_min.value_or(NAN)}};
}

void one_sense(const CircularPassResult& pass, Values& values) {
  const std::string end = pass.direction > 0 ? "_CCW" : "_CW";
  if (values.contains("AF_CIRCULAR_DEVIATION" + end)) return;  // of the first pass in that direction
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

void both_senses(const CircularResult& circle, Values& values) {
  if (!circle.about_mean) return;
  values["AF_CIRCULAR_DEVIATION_BIDIRECTIONAL"] = *circle.bidirectional_um;
  values["AF_CIRCULAR_HYSTERESIS"] = circle.hysteresis->um;
  values["AF_CIRCULAR_HYSTERESIS_LOCATION"] = circle.hysteresis->deg;
  values["AF_MEAN_BIDIRECTIONAL_RADIAL_DEVIATION"] = *circle.mean_bidirectional_radial_um;
  const AboutMean& mean = *circle.about_mean;
  values["AF_NON_ROUNDNESS"] = values["AF_BIDIRECTIONAL_CIRCULAR_DEVIATION"] = mean.max_um - mean.min_um;
  values["AF_MAX_CIRCULAR_DEVIATION"] = mean.max_um;
  values["AF_MIN_CIRCULAR_DEVIATION"] = mean.min_um;
  values["AF_MAX_CIRCULAR_DEVIATION_LOCATION"] = mean.max_deg;
  values["AF_MIN_CIRCULAR_DEVIATION_LOCATION"] = mean.min_deg;
  values["AF_CENTRE_OFFSET_A"] = *circle.mean_centre_a_mm * maths::kUmPerMm;
  values["AF_CENTRE_OFFSET_B"] = *circle.mean_centre_b_mm * maths::kUmPerMm;
  values["AF_BEST_RADIUS"] = *circle.mean_radius_mm;
  if (const auto feed = mean_feed_mm_min(circle)) values["AF_CALCULATED_FEEDRATE"] = *feed;
}

RecomputedResults analysis_values(const CircularResult& circle) {
  Values values;
  for (const auto& pass : circle.passes) one_sense(pass, values);
  both_senses(circle, values);
  return {{{"readings", values}}, {}};
}

void compare(const std::string& place, const std::vector<BallbarFeature>& features,
             const RecomputedResults& computed, std::vector<PrintedResult>& results) {
  for (const auto& feature : features) {
    PrintedResult result{place, feature.name, feature.unit, feature.value, std::nullopt, false, "", ""};
    for (const auto& [from, values] : computed.values) {
      const auto found = values.find(feature.name);
      if (found == values.end()) continue;
      result.computed = found->second;
      result.from = from;
      // Half a digit, plus a small amount for the rounding of a number just between two.
      result.equal = std::abs(found->second - feature.value) <= 0.5001 * last_digit(feature.unit);
    }
    if (const auto why = computed.why.find(feature.name); why != computed.why.end()) {
      result.why = why->second;
    } else if (!result.computed) {
      result.why = "this result is not known to the program, or the file does not contain its input data";
    }
    results.push_back(result);
  }
}

}  // namespace

std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle) {
  std::vector<PrintedResult> results;
  for (std::size_t i = 0; i < file.runs.size(); ++i) {
    compare(file.runs[i].label, file.runs[i].features, {{{"readings", run_values(circle.passes[i])}}, {}},
            results);
  }
  const RecomputedResults values = analysis_values(circle);
  for (const auto& analysis : file.analyses) {
    // Centre and radius of the diagnostics come from their model of the whole test, not from a circle.
    const bool diagnostics = analysis.name == kDiagnosticsAnalysis;
    compare(analysis.name + (analysis.version.empty() ? "" : " " + analysis.version), analysis.features,
            diagnostics ? recompute_diagnostics(file, analysis, circle) : values, results);
  }
  return results;
}

}  // namespace vernier::importer
