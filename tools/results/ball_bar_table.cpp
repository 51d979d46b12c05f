// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/ball_bar_table.h"

#include <algorithm>
#include <array>
#include <string>

#include "tools/import/ballbar/diagnostics.h"
#include "tools/maths/factors.h"

namespace vernier::results {
namespace {

using Json = nlohmann::ordered_json;

/// In the order of kDiagnosticsNames; A and B are placeholders for the axes of the plane, an empty name is
/// not written.
constexpr std::array<const char*, importer::kDiagnosticsCount> kWords = {
    "scale of both axes",
    "",
    "",
    "scale mismatch",
    "squareness",
    "straightness of A",
    "straightness of B",
    "servo mismatch",
    "fourth wave",
    "radius, between the senses",
    "centre along A, difference between the directions of rotation",
    "centre along B, difference between the directions of rotation",
    "backlash of A",
    "backlash of A, difference between its ends",
    "backlash of B",
    "backlash of B, difference between its ends",
    "lateral play of A",
    "lateral play of A, difference between its ends",
    "lateral play of B",
    "lateral play of B, difference between its ends"};

/// The letter of the axis for A and B if they are separate words.
std::string in_words(const char* words, const Circle& circle) {
  std::string text = words;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string mark = std::string("of ") + "AB"[k], along = std::string("along ") + "AB"[k];
    for (const std::string& one : {mark, along})
      if (const auto at = text.find(one); at != std::string::npos)
        text[at + one.size() - 1] = "XYZ"[circle.plane[k]];
  }
  return text;
}

}  // namespace

Json ball_bar_table(const Circle& circle, const model::Measurement& m) {
  importer::DiagnosticsSetup setup;
  setup.radius_mm = circle.nominal_radius_mm;
  std::vector<importer::DiagnosticsSample> samples;
  std::array<bool, 2> senses{};
  for (const CircleRun& run : circle.runs)
    for (std::size_t i = 0; i < run.observation.size(); ++i) {
      const model::Observation& o = m.observations[run.observation[i]];
      if (m.check[o.row] != 0) continue;
      if (const double feed = m.states.feed[static_cast<Eigen::Index>(o.row)]; feed > 0)
        setup.feed_mm_min = feed;
      senses[run.direction > 0 ? 0 : 1] = true;
      samples.push_back(
          {run.angle_deg[i], run.direction, maths::kUmPerMm * (o.value - circle.nominal_radius_mm)});
    }
  constexpr std::size_t kFewest = 4 * importer::kDiagnosticsCount;  // readings: four for each unknown
  if (!senses[0] || !senses[1] || samples.size() < kFewest) return nullptr;
  const importer::DiagnosticsResult found = importer::fit_diagnostics(samples, setup);
  if (found.rank < found.columns) return nullptr;
  std::array<double, importer::kDiagnosticsCount> low{}, high{};
  for (const importer::DiagnosticsSample& sample : samples) {
    const auto basis = importer::diagnostics_basis(sample.angle_deg, sample.direction, setup);
    for (std::size_t k = 0; k < importer::kDiagnosticsCount; ++k) {
      low[k] = std::min(low[k], basis[k] * found.value[k]);
      high[k] = std::max(high[k], basis[k] * found.value[k]);
    }
  }
  double all = 0;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < importer::kDiagnosticsCount; ++k) {
    if (*kWords[k] == '\0') continue;
    order.push_back(k);
    all += high[k] - low[k];
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return high[a] - low[a] > high[b] - low[b]; });
  Json table = Json::array();
  for (const std::size_t k : order)
    table.push_back({{"name", in_words(kWords[k], circle)},
                     {"value", found.value[k]},
                     {"unit", importer::kDiagnosticsUnits[k]},
                     {"effect_um", high[k] - low[k]},
                     {"share", all > 0 ? (high[k] - low[k]) / all : 0}});
  return table;
}

}  // namespace vernier::results
