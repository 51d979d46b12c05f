// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/circular.h"
#include "tools/import/ballbar/diagnostics.h"

namespace vernier::importer {

inline constexpr const char* kDiagnosticsAnalysis = "RENISHAW_DIAGNOSTICS";

/// Computed results, each with its data and its printed name. Remarks on names state why a result cannot be
/// computed, or may differ.
struct RecomputedResults {
  std::map<std::string, std::map<std::string, double>> values;
  std::map<std::string, std::string> why;
};

/// Mean of the feeds of a test's passes, mm/min; `nullopt` if a pass has no feed.
std::optional<double> mean_feed_mm_min(const CircularResult& circle);

/// Returns the model curve of the file as samples of a test: its SIMULATION series, both on the grid of the
/// clockwise run, one sample in the middle of each step. Source: found by recomputing
/// (tests/data/ballbar/README.md).
std::vector<DiagnosticsSample> model_curve(const BallbarFile& file);

/// Computes again the diagnostics that the ball bar's software wrote into the file. The linear diagnostics
/// and cyclic errors come from the model curve of the file. Values at the ends, shares and ranks follow from
/// these; roundness and the other results come from the readings.
RecomputedResults recompute_diagnostics(const BallbarFile& file, const BallbarAnalysis& analysis,
                                        const CircularResult& circle);

}  // namespace vernier::importer
