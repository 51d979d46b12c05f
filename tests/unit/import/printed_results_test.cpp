// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/printed_results.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_motion.h"

namespace vernier::printed_results_test {

using namespace vernier::importer;
namespace {

std::vector<PrintedResult> results_of(const BallbarFile& file) {
  return printed_results(file, analyse_circle(file.radius_mm, circular_passes(file)));
}

// What the file prints and nobody outside knows how: 4 phases, 4 spikes, 2 pitches that are settings, a
// tolerance.
const std::set<std::string> kNotComputed = {
    "AF_CYCLIC_PHASE_A_FWD",    "AF_CYCLIC_PHASE_A_REV",    "AF_CYCLIC_PHASE_B_FWD",
    "AF_CYCLIC_PHASE_B_REV",    "AF_REVERSAL_SPIKES_A_POS", "AF_REVERSAL_SPIKES_A_NEG",
    "AF_REVERSAL_SPIKES_B_POS", "AF_REVERSAL_SPIKES_B_NEG", "AF_CYCLIC_PITCH_A",
    "AF_CYCLIC_PITCH_B",        "AF_POSITIONAL_TOLERANCE"};

TEST(PrintedResults, EveryResultOfTheFileIsRecomputedOrSaidNotToBe) {
  const auto results = results_of(read_b5r(ballbar_data("ur10e_xy_100mm.b5r")));
  EXPECT_EQ(results.size(), 194u);
  std::size_t equal = 0;
  for (const auto& result : results) {
    equal += result.equal ? 1 : 0;
    if (result.name == "RMS") continue;
    EXPECT_EQ(result.computed.has_value(), !kNotComputed.contains(result.name))
        << result.place << ' ' << result.name;
    EXPECT_EQ(result.why.empty(), result.computed.has_value()) << result.place << ' ' << result.name;
    EXPECT_EQ(result.equal, result.computed.has_value())
        << result.place << ' ' << result.name << ": printed " << result.printed << ", computed "
        << result.computed.value_or(0);
  }
  EXPECT_EQ(equal, 182u);
}

TEST(PrintedResults, RmsOfTheModelsRestIsNearAndSaysWhyNotEqual) {
  for (const auto& result : results_of(read_b5r(ballbar_data("ur10e_xy_100mm.b5r")))) {
    if (result.name != "RMS") continue;
    // Taken between samples or at the nearest one, it is 42.12 to 42.32 um.
    EXPECT_NEAR(result.computed.value(), result.printed, 0.15);
    EXPECT_FALSE(result.why.empty());
  }
}

TEST(PrintedResults, WithoutTheModelCurveDiagnosticsAreNotComputed) {
  BallbarFile file = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  file.simulations.clear();
  std::size_t computed = 0, diagnostics = 0;
  for (const auto& result : results_of(file)) {
    if (result.place != "RENISHAW_DIAGNOSTICS 2.0") continue;
    ++diagnostics;
    computed += result.computed ? 1 : 0;
    EXPECT_EQ(result.why.empty(), result.computed.has_value()) << result.name;
  }
  EXPECT_EQ(diagnostics, 88u);
  EXPECT_EQ(computed, 1u);  // the feed
}

}  // namespace
}  // namespace vernier::printed_results_test
