// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/printed_diagnostics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

using Values = std::map<std::string, double>;

constexpr const char* kOnlyPrinted =
    "the definition of this result is not published, and no tested definition gives the printed value";

std::optional<double> printed(const BallbarAnalysis& analysis, const std::string& name) {
  for (const auto& feature : analysis.features)
    if (feature.name == name) return feature.value;
  return std::nullopt;
}

struct Extent {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void take(double value) { low = std::min(low, value), high = std::max(high, value); }
  double span() const { return high - low; }
};

std::size_t diagnostic(const std::string& name) {
  const auto* const found = std::find(kDiagnosticsNames.begin(), kDiagnosticsNames.end(), name);
  return static_cast<std::size_t>(found - kDiagnosticsNames.begin());
}

// Joint effect of the named terms on the radius over all samples, um.
double effect_um(const std::vector<DiagnosticsSample>& samples, const DiagnosticsSetup& setup,
                 const DiagnosticsResult& found, const std::vector<std::string>& terms) {
  Extent extent;
  for (const auto& sample : samples) {
    const auto basis = diagnostics_basis(sample.angle_deg, sample.direction, setup);
    double um = 0;
    for (const auto& term : terms) um += basis[diagnostic(term)] * found.value[diagnostic(term)];
    extent.take(um);
  }
  return extent.span();
}

// Linear diagnostics, what follows from them, and their effects on the circle (AF_…_IC).
void take_linear(const std::vector<DiagnosticsSample>& samples, const DiagnosticsSetup& setup,
                 const DiagnosticsResult& found, Values& values) {
  const auto value = [&](const std::string& name) { return found.value[diagnostic(name)]; };
  for (std::size_t i = 0; i < kDiagnosticsCount; ++i)
    values[std::string("AF_") + kDiagnosticsNames[i]] = found.value[i];
  values["AF_BEST_RADIUS"] = setup.radius_mm + value("GLOBAL_SCALE") / maths::kUmPerMm;
  const double radius_m = setup.radius_mm / 1e3;
  for (const std::string axis : {"A", "B"}) {
    const double sense = axis == "A" ? +1 : -1;
    // The mismatch is of the diameters: each axis has half of it, on its radius.
    values["AF_SCALE_ERROR_" + axis] =
        (value("GLOBAL_SCALE") + sense * value("SCALE_MISMATCH") / 4) / radius_m;
    for (const std::string kind : {"BACKLASH_", "LATERAL_PLAY_"}) {
      const std::string name = kind + axis;
      values["AF_" + name + "_POS"] = value(name + "_GLOBAL") + value(name + "_MISMATCH");
      values["AF_" + name + "_NEG"] = value(name + "_GLOBAL") - value(name + "_MISMATCH");
      values["AF_" + name + "_IC"] = effect_um(samples, setup, found, {name + "_GLOBAL", name + "_MISMATCH"});
    }
    values["AF_STRAIGHTNESS_" + axis + "_IC"] = effect_um(samples, setup, found, {"STRAIGHTNESS_" + axis});
  }
  for (const std::string name : {"SERVO_MISMATCH", "SQUARENESS", "SCALE_MISMATCH"})
    values["AF_" + name + "_IC"] = effect_um(samples, setup, found, {name});
}

// The printed values are those of the clockwise direction; the file's curve of the other direction contains
// others.
void take_cyclic(const DiagnosticsResult& found, Values& values) {
  for (const auto& cyclic : found.cyclic)
    if (cyclic.direction < 0)
      values[std::string("AF_CYCLIC_ERROR_") + cyclic.axis + (cyclic.forward ? "_FWD" : "_REV")] =
          cyclic.peak_to_peak_um;
  for (const auto& effect : found.cyclic_effect)
    if (effect.direction < 0) values[std::string("AF_CYCLIC_ERROR_") + effect.axis + "_IC"] = effect.um;
}

// Largest minus smallest reading of both directions about the centre of the diagnostics, um.
double roundness_um(const BallbarFile& file, const DiagnosticsResult& found) {
  const double a = found.value[diagnostic("CENTRE_OFFSET_A")], b = found.value[diagnostic("CENTRE_OFFSET_B")];
  Extent extent;
  for (const auto& pass : circular_passes(file))
    for (std::size_t i = 0; i < pass.angle_deg.size(); ++i) {
      const double angle = pass.angle_deg[i] * maths::kRadPerDeg;
      extent.take(pass.deviation_mm[i] * maths::kUmPerMm - a * std::cos(angle) - b * std::sin(angle));
    }
  return extent.span();
}

// Rms of readings minus model curve, readings taken between samples where the curve's grid is another one.
double rest_um(const BallbarFile& file) {
  double squares = 0, count = 0;
  for (const auto& pass : circular_passes(file))
    for (const auto& series : file.simulations) {
      if (series.label != pass.label) continue;
      const auto have = static_cast<double>(pass.deviation_mm.size());
      for (std::size_t k = 0; k < series.reading_mm.size(); ++k, ++count) {
        const double at =
            (static_cast<double>(k) + 0.5) * have / static_cast<double>(series.reading_mm.size()) - 0.5;
        const auto i = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, have - 2));
        const double share = at - static_cast<double>(i);
        const double reading = (1 - share) * pass.deviation_mm[i] + share * pass.deviation_mm[i + 1];
        squares += std::pow((reading - series.reading_mm[k]) * maths::kUmPerMm, 2);
      }
    }
  return std::sqrt(squares / count);
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Share and rank of every effect that the file prints, from the effects computed so far.
void take_ranking(const BallbarAnalysis& analysis, RecomputedResults& results) {
  std::vector<std::pair<std::string, double>> effects;
  double all = 0;
  for (const auto& feature : analysis.features) {
    if (!ends_with(feature.name, "_IC")) continue;
    for (const auto& [from, values] : results.values)
      if (const auto found = values.find(feature.name); found != values.end()) {
        effects.emplace_back(feature.name.substr(0, feature.name.size() - 3), found->second);
        all += found->second;
      }
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const auto& x, const auto& y) { return x.second > y.second; });
  Values& ranking = results.values["model curve"];
  for (std::size_t i = 0; i < effects.size(); ++i) {
    ranking[effects[i].first + "_RANK"] = static_cast<double>(i + 1);
    ranking[effects[i].first + "_PERC"] = std::round(100 * effects[i].second / all);
  }
}

void say_what_is_not_known(RecomputedResults& results) {
  const std::string not_found = std::string(": ") + kOnlyPrinted;
  for (const char* sense : {"A_FWD", "A_REV", "B_FWD", "B_REV"})
    results.why[std::string("AF_CYCLIC_PHASE_") + sense] = "from where a phase counts" + not_found;
  for (const char* end : {"A_POS", "A_NEG", "B_POS", "B_NEG"})
    results.why[std::string("AF_REVERSAL_SPIKES_") + end] =
        "one value for the reversal spikes of both directions" + not_found;
  for (const char* axis : {"A", "B"})
    results.why[std::string("AF_CYCLIC_PITCH_") + axis] =
        "a setting of the ball bar's software; the value of the file is used";
  results.why["AF_POSITIONAL_TOLERANCE"] = kOnlyPrinted;
  results.why["RMS"] =
      "the software's interpolation of the readings to the grid of the curve is not known" + not_found;
}

}  // namespace

std::optional<double> mean_feed_mm_min(const CircularResult& circle) {
  double sum = 0;
  for (const auto& pass : circle.passes) {
    if (!pass.feed_mm_min) return std::nullopt;
    sum += *pass.feed_mm_min;
  }
  return circle.passes.empty() ? std::nullopt
                               : std::optional(sum / static_cast<double>(circle.passes.size()));
}

std::vector<DiagnosticsSample> model_curve(const BallbarFile& file) {
  std::vector<DiagnosticsSample> samples;
  for (const auto& series : file.simulations) {
    const double count = static_cast<double>(series.reading_mm.size());
    for (std::size_t k = 0; k < series.reading_mm.size(); ++k) {
      const double turned = (static_cast<double>(k) + 0.5) * 360 / count;
      const bool ccw = series.label == "CCW";
      samples.push_back({ccw ? turned : 360 - turned, ccw ? +1 : -1, series.reading_mm[k] * maths::kUmPerMm});
    }
  }
  return samples;
}

RecomputedResults recompute_diagnostics(const BallbarFile& file, const BallbarAnalysis& analysis,
                                        const CircularResult& circle) {
  RecomputedResults results;
  say_what_is_not_known(results);
  const auto feed = mean_feed_mm_min(circle);
  const std::vector<DiagnosticsSample> samples = model_curve(file);
  DiagnosticsSetup setup;
  setup.radius_mm = file.radius_mm;
  setup.pitch_a_mm = printed(analysis, "AF_CYCLIC_PITCH_A").value_or(0);
  setup.pitch_b_mm = printed(analysis, "AF_CYCLIC_PITCH_B").value_or(0);
  if (feed) results.values["readings"]["AF_CALCULATED_FEEDRATE"] = setup.feed_mm_min = *feed;
  // Readings: four for each unknown of the model.
  constexpr std::size_t kFewest = 4 * (kDiagnosticsCount + 16);
  if (!feed || samples.size() < kFewest) return results;
  const DiagnosticsResult found = fit_diagnostics(samples, setup);
  if (found.rank < found.columns) return results;
  Values& curve = results.values["model curve"];
  take_linear(samples, setup, found, curve);
  take_cyclic(found, curve);
  curve["AF_CIRCULARITY"] = roundness_um(file, found);
  curve["RMS"] = rest_um(file);
  for (const std::string axis : {"A", "B"}) {
    const auto pos = printed(analysis, "AF_REVERSAL_SPIKES_" + axis + "_POS");
    const auto neg = printed(analysis, "AF_REVERSAL_SPIKES_" + axis + "_NEG");
    if (pos && neg)
      results.values["printed results"]["AF_REVERSAL_SPIKES_" + axis + "_IC"] =
          std::max(std::abs(*pos), std::abs(*neg));
  }
  take_ranking(analysis, results);
  return results;
}

}  // namespace vernier::importer
