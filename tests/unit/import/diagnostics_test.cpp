// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/diagnostics.h"
#include "tools/import/ballbar/printed_diagnostics.h"

namespace vernier::diagnostics_test {

using namespace vernier::importer;
namespace {

constexpr const char* kAnalysis = "RENISHAW_DIAGNOSTICS";

DiagnosticsSetup setup_of(const BallbarFile& file) {
  const auto printed = [&](const char* name) { return printed_result(file, kAnalysis, "2.0", name).value(); };
  DiagnosticsSetup setup;
  setup.radius_mm = file.radius_mm;
  setup.feed_mm_min = printed("AF_CALCULATED_FEEDRATE");
  setup.pitch_a_mm = printed("AF_CYCLIC_PITCH_A");
  setup.pitch_b_mm = printed("AF_CYCLIC_PITCH_B");
  return setup;
}

TEST(Diagnostics, FilesOwnSimulationGivesAllTwentyPrintedValues) {
  const BallbarFile file = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  const DiagnosticsResult result = fit_diagnostics(model_curve(file), setup_of(file));
  EXPECT_EQ(result.rank, result.columns);
  // The series is printed to 0.01 um; a uniform rounding error of that width has 0.003 um rms.
  EXPECT_LT(result.rms_um, 0.01);
  EXPECT_LT(result.max_um, 0.03);
  for (std::size_t i = 0; i < kDiagnosticsCount; ++i) {
    const std::string name = std::string("AF_") + kDiagnosticsNames[i];
    const auto printed = printed_result(file, kAnalysis, "2.0", name);
    ASSERT_TRUE(printed.has_value()) << name;
    // Lengths and squareness are printed with one digit behind the point, the servo mismatch with two or
    // more.
    const double half_digit = std::string(kDiagnosticsUnits[i]) == "ms" ? 0.005 : 0.05;
    EXPECT_NEAR(result.value[i], *printed, half_digit * 1.001) << name;
  }
}

TEST(Diagnostics, CyclicAmplitudesOfTheClockwiseSimulationAreThePrintedOnes) {
  const BallbarFile file = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  const DiagnosticsResult result = fit_diagnostics(model_curve(file), setup_of(file));
  std::size_t compared = 0;
  for (const auto& cyclic : result.cyclic) {
    if (cyclic.direction > 0) continue;
    const std::string name =
        std::string("AF_CYCLIC_ERROR_") + cyclic.axis + (cyclic.forward ? "_FWD" : "_REV");
    EXPECT_NEAR(cyclic.peak_to_peak_um, printed_result(file, kAnalysis, "2.0", name).value(), 0.051) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 4u);
}

TEST(Diagnostics, EveryDiagnosticAloneComesBack) {
  constexpr unsigned kSeed = 20260;
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  std::uniform_real_distribution<double> amount(-50, 50);
  const DiagnosticsSetup setup;
  for (std::size_t which = 0; which < kDiagnosticsCount; ++which) {
    const double truth = amount(random);
    std::vector<DiagnosticsSample> samples;
    for (const int direction : {+1, -1}) {
      for (int k = 0; k < 1000; ++k) {
        const double angle_deg = (k + 0.5) * 0.36;
        samples.push_back(
            {angle_deg, direction, truth * diagnostics_basis(angle_deg, direction, setup)[which]});
      }
    }
    const DiagnosticsResult result = fit_diagnostics(samples, setup);
    EXPECT_EQ(result.rank, kDiagnosticsCount);
    for (std::size_t i = 0; i < kDiagnosticsCount; ++i) {
      // Double arithmetic through a basis whose condition is about 1e3.
      EXPECT_NEAR(result.value[i], i == which ? truth : 0, 1e-9)
          << kDiagnosticsNames[i] << " from " << kDiagnosticsNames[which];
    }
  }
}

TEST(Diagnostics, OneSenseCannotSeparateAndSaysSo) {
  std::vector<DiagnosticsSample> samples;
  for (int k = 0; k < 1000; ++k) samples.push_back({(k + 0.5) * 0.36, +1, 1.0});
  const DiagnosticsResult result = fit_diagnostics(samples, {});
  EXPECT_LT(result.rank, result.columns);
}

TEST(Diagnostics, TooFewSamplesAreRefused) {
  EXPECT_THROW(fit_diagnostics({{45, 1, 0}}, {}), std::invalid_argument);
  EXPECT_THROW(fit_diagnostics({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vernier::diagnostics_test
