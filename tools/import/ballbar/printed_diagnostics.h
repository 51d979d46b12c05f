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

/// Results that were computed again from the data of a file, by the name of their data and their printed
/// name. The member `why` states, by name, why a result cannot be computed, or why it may differ from the
/// printed result.
struct RecomputedResults {
  std::map<std::string, std::map<std::string, double>> values;
  std::map<std::string, std::string> why;
};

/// Returns the mean feed of all passes of a test, mm/min; nullopt if a pass has no feed.
std::optional<double> mean_feed_mm_min(const CircularResult& circle);

/// Returns the model curve of a ball-bar file as samples of a test. The model curve is the SIMULATION series
/// of the file, for both directions on the grid of the clockwise run, with one sample in the middle of each
/// step. The meaning of this grid was found by recomputing the diagnostics (tests/data/ballbar/README.md).
std::vector<DiagnosticsSample> model_curve(const BallbarFile& file);

/// Computes the diagnostics again that the software of the ball bar wrote into the file. The linear
/// least-squares diagnostics and the cyclic errors are computed from the SIMULATION series of the file, not
/// from the readings. Values at the ends, shares and ranks are computed from these diagnostics. Roundness and
/// the other results are computed from the readings.
RecomputedResults recompute_diagnostics(const BallbarFile& file, const BallbarAnalysis& analysis,
                                        const CircularResult& circle);

}  // namespace vernier::importer
