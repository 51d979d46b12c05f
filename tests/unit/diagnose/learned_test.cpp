// SPDX-License-Identifier: GPL-3.0-or-later
// Terms learned on accelerometer features: proved on whole feeds, written within their domain.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/fit/coverage/domain.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"

namespace vernier::learned_test {

using namespace vernier::diagnose;
using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr unsigned kSeed = 31;

constexpr const char* kMachine =
    "<machine name=\"m\"><variables><static><sq value=\"0\" nominal=\"0\" "
    "unit=\"rad\"/></static><machineaxes>"
    "<X min=\"0\" max=\"400\"/><Y min=\"0\" max=\"400\"/></machineaxes><inputs><T unit=\"degC\" "
    "reference=\"20\"/></inputs>"
    "</variables><transforms><sixdof n=\"1\" X=\"X-sq*Y\" Y=\"Y\"/></transforms></machine>";

/// Every run has rows at three feeds; the X error is slope[feed] times the feature, 0.3 um of noise.
std::string survey(const std::array<double, 3>& slope_mm_per_g) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(0, 400), share(0.3, 1);
  std::normal_distribution<double> noise(0, 0.0003);
  constexpr std::array<double, 3> kFeed = {100, 250, 500}, kSize_g = {0.04, 0.04, 0.06};
  std::string text = "X[mm],Y[mm],feed[mm/min],T[degC],table_RMS[g],x[mm],y[mm],u[mm],run\n";
  for (std::size_t run = 0; run < 6; ++run)
    for (std::size_t i = 0; i < 60; ++i) {
      const double x = place(random), y = place(random), rms = kSize_g[i % 3] * share(random);
      text += fmt::format("{},{},{},{},{},{},{},0.0003,r{}\n", x, y, kFeed[i % 3],
                          20 + 0.01 * static_cast<double>(run), rms,
                          x + slope_mm_per_g[i % 3] * rms + noise(random), y + noise(random), run);
    }
  return text;
}

Diagnosis diagnosis_of(const std::string& rows) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  static const DiagnoseOptions kOptions;  // the candidates point into its catalogue
  return diagnose::diagnose(kMachine, machine, parse_measurement(rows, "m.csv", machine), kOptions);
}

TEST(LearnedTerm, ThatHoldsAtEveryFeedIsWrittenWithinItsDomain) {
  const Diagnosis d = diagnosis_of(survey({0.15, 0.15, 0.15}));
  ASSERT_EQ(d.verdict, Verdict::kMissingEffect) << d.explanation;
  EXPECT_EQ(d.candidates[0].candidate.choice.effect->id, "vibration");
  ASSERT_EQ(d.ladder.size(), 2u);
  const Machine learned = parse_machine(d.machine_text, "m.xml");
  const auto ranges = domain_ranges(learned);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].quantity, "table_RMS");
  EXPECT_NEAR(ranges[0].low, 0.012, 0.002);
  EXPECT_NEAR(ranges[0].high, 0.06, 0.002);
  EXPECT_EQ(ranges[1].quantity, "T");
  const Measurement use = parse_measurement(
      "X[mm],Y[mm],T[degC],table_RMS[g],x[mm]\n0,0,20,0.04,0\n0,0,25,0.04,0\n0,0,20,0.2,0\n", "u.csv",
      learned);
  const Eigen::Matrix3Xd deviations = deviation(learned, use.states);
  EXPECT_NEAR(deviations(0, 0), 0.15 * 0.04, 1e-4);
  EXPECT_EQ(deviations(0, 1), 0);  // never trained as warm
  EXPECT_EQ(deviations(0, 2), 0);  // nor with so much vibration
}

TEST(LearnedTerm, ThatHoldsAtOneFeedAloneIsRefused) {
  // Each run alone would accept it: every run has all feeds.
  const Diagnosis d = diagnosis_of(survey({0, 0, 0.15}));
  for (const LadderStep& step : d.ladder) EXPECT_NE(step.effect, "vibration");
  const auto refused =
      std::find_if(d.candidates.begin(), d.candidates.end(), [](const CandidateFinding& one) {
        return one.candidate.choice.effect->id == "vibration" && one.candidate.terms[0].place.dof == 0;
      });
  if (refused != d.candidates.end()) {
    EXPECT_FALSE(refused->accepted);
  }
}

}  // namespace
}  // namespace vernier::learned_test
