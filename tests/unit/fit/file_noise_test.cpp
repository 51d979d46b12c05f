// SPDX-License-Identifier: GPL-3.0-or-later
// Readings without u beside readings with u: their noise is estimated, not taken as 1 mm.
#include "tools/fit/files/file_noise.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::file_noise_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr double kSquareness = 55e-6, kTracker_mm = 6e-3;

/// Three axes with a free squareness and a free scale of X, and one set-up for each of the two instruments.
Machine machine() {
  return parse_machine(
      "<machine name=\"m\"><variables><static><EC0Y value=\"0\" nominal=\"0\" unit=\"rad\"/>"
      "<sx value=\"0\" nominal=\"0\"/><BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>"
      "<BaseShift setup=\"tracker\" X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></static>"
      "<machineaxes><X min=\"0\" max=\"800\"/><Y min=\"0\" max=\"500\"/><Z min=\"-400\" max=\"0\"/>"
      "</machineaxes></variables><transforms branch=\"tool\">"
      "<sixdof X=\"X*(1+sx)-EC0Y*Y\" Y=\"Y\" Z=\"Z\"/></transforms></machine>",
      "m.xml");
}

std::string laser(std::mt19937_64& random, double squareness = kSquareness) {
  std::normal_distribution<double> noise(0, 0.5e-3);
  std::string csv = "X[mm],Y[mm],Z[mm],x[mm],u[um]\n";
  for (int i = 0; i <= 20; ++i)
    csv += fmt::format("{},250,-200,{:.6f},0.5\n", 40 * i,
                       40 * i * (1 + 30e-6) - squareness * 250 + noise(random));
  return csv;
}

/// `repeats`: how often each point is read. `head`, `tail`: of an additional column.
std::string tracker(std::mt19937_64& random, int points, int repeats = 1, const std::string& head = "",
                    const std::string& tail = "") {
  std::normal_distribution<double> noise(0, kTracker_mm);
  std::uniform_real_distribution<double> share(0, 1);
  std::string csv = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm]" + head + "\n";
  for (int i = 0; i < points; ++i) {
    const double x = 800 * share(random), y = 500 * share(random), z = -400 * share(random);
    for (int k = 0; k < repeats; ++k)
      csv += fmt::format("{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f}{}\n", x, y, z,
                         x * (1 + 30e-6) - kSquareness * y + noise(random), y + noise(random),
                         z + noise(random), tail);
  }
  return csv;
}

Measurement both(const std::string& first, const std::string& second) {
  Measurement all = parse_measurement(first, "laser.csv", machine());
  append_measurement(all, parse_measurement(second, "tracker.csv", machine()));
  return all;
}

TEST(FileNoise, AFileWithoutUGetsItsOwnNoise) {
  std::mt19937_64 random(20261129);
  Measurement rows = both(laser(random), tracker(random, 75));
  const std::vector<FileNoise> noise = estimate_file_noise(machine(), rows);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].name, "tracker.csv");
  EXPECT_FALSE(noise[0].open);
  // 225 readings, less the six values of the set-up and most of the squareness.
  EXPECT_NEAR(noise[0].freedom, 218, 1.5);
  EXPECT_NEAR(noise[0].u, kTracker_mm, 3 * noise[0].std);
  EXPECT_NEAR(noise[0].std, kTracker_mm / std::sqrt(2 * 218.0), 0.05e-3);
  EXPECT_NE(noise[0].sentence().find("tracker.csv: the lengths of this file have no u"), std::string::npos);
  const FitResult fitted = fit::fit(machine(), rows);
  for (const ParameterEstimate& one : fitted.estimates)
    if (one.name == "EC0Y") {
      EXPECT_NEAR(one.value, kSquareness, 4 * one.std);
      // 6 um / (144 mm * sqrt(75)) is 4.8 urad; the rotation of the set-up adds to it.
      EXPECT_LT(one.std, 7e-6);
    }
}

/// A scale of Y of 1 mm/m, ten times its plausible value, which the readings of the second file alone show.
std::string of_scale(std::mt19937_64& random, int readings) {
  std::normal_distribution<double> noise(0, kTracker_mm);
  std::string csv = "X[mm],Y[mm],Z[mm],y[mm]\n";
  for (int i = 0; i < readings; ++i) {
    const double y = 500.0 * i / (readings - 1);
    csv += fmt::format("400,{:.3f},-200,{:.6f}\n", y, y * (1 + 1e-3) + noise(random));
  }
  return csv;
}

TEST(FileNoise, AFileIsNotGivenUpForItsOwnError) {
  const Machine plausible = parse_machine(
      "<machine name=\"m\"><variables><static><sy value=\"0\" nominal=\"0\" scale=\"0.0001\"/>"
      "<sx value=\"0\" nominal=\"0\"/></static>"
      "<machineaxes><X min=\"0\" max=\"800\"/><Y min=\"0\" max=\"500\"/><Z min=\"-400\" max=\"0\"/>"
      "</machineaxes></variables><transforms branch=\"tool\">"
      "<sixdof X=\"X*(1+sx)\" Y=\"Y*(1+sy)\" Z=\"Z\"/></transforms></machine>",
      "m.xml");
  std::mt19937_64 random(20261201);
  const auto survey = [&](int readings) {
    Measurement rows = parse_measurement(laser(random, 0), "laser.csv", plausible);
    append_measurement(rows, parse_measurement(of_scale(random, readings), "scale.csv", plausible));
    return rows;
  };
  Measurement rows = survey(20);
  const std::vector<FileNoise> noise = estimate_file_noise(plausible, rows);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_NEAR(noise[0].u, kTracker_mm, 4 * noise[0].std);
  for (const ParameterEstimate& one : fit::fit(plausible, rows).estimates)
    if (one.name == "sy") {
      EXPECT_NEAR(one.value, 1e-3, 5e-5);
    }
  // Too few readings for an estimate are refused, not given the size of their error as u.
  Measurement few = survey(5);
  EXPECT_THROW(estimate_file_noise(plausible, few), text::InputError);
}

TEST(FileNoise, OutliersCountAsThreeStandardDeviations) {
  std::mt19937_64 random(20261130);
  Measurement rows = both(laser(random), tracker(random, 75));
  rows.observations.back().value += 10;  // a lost beam, mm
  const std::vector<FileNoise> noise = estimate_file_noise(machine(), rows);
  // One reading in 225 with a squared residual of 9: 2 % of u; the outlier moves the set-up by 10 mm / 75.
  EXPECT_LT(noise.at(0).u, 30 * kTracker_mm);
}

TEST(FileNoise, RepeatsInTheFileCountBeforeTheResidual) {
  std::mt19937_64 random(20261131);
  Measurement rows = both(laser(random), tracker(random, 20, 3));
  const std::vector<FileNoise> noise = estimate_file_noise(machine(), rows);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].source, FileNoise::Source::kRepeats);
  EXPECT_EQ(noise[0].freedom, 120);  // 20 points, 3 coordinates, 2 each
  EXPECT_NEAR(noise[0].u, kTracker_mm, 3 * noise[0].std);
}

constexpr int kRuns = 5, kTargets = 11;

/// Five runs of a linear test: each run is a set-up of its own, with an offset of up to 20 um.
std::string runs(std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, 0.5e-3), offset(0, 10e-3);
  std::string csv = "X[mm],dirX,run,Y[mm],Z[mm],x[mm]\n";
  for (int run = 0; run < kRuns; ++run) {
    const double shift = offset(random);
    for (const int sense : {1, -1})
      for (int i = 0; i < kTargets; ++i)
        csv += fmt::format("{},{},{},250,-200,{:.6f}\n", 80 * i, sense, run,
                           80 * i + 7e-3 * sense + shift + noise(random));
  }
  return csv;
}

TEST(FileNoise, RepeatsInOtherRunsCountBesideAnOffsetOfEachRun) {
  std::mt19937_64 random(20261134);
  Measurement rows = parse_measurement(tracker(random, 20, 1, ",u[um]", ",6"), "tracker.csv", machine());
  append_measurement(rows, parse_measurement(runs(random), "runs.csv", machine()));
  const std::vector<FileNoise> estimate = estimate_file_noise(machine(), rows);
  ASSERT_EQ(estimate.size(), 1u);
  EXPECT_EQ(estimate[0].source, FileNoise::Source::kRepeatsInRuns) << estimate[0].sentence();
  EXPECT_EQ(estimate[0].freedom, 2 * kTargets * (kRuns - 1) - (kRuns - 1));
  EXPECT_NEAR(estimate[0].u, 0.5e-3, 3 * estimate[0].std);
}

TEST(FileNoise, TooFewReadingsAreRefusedWithTheRemedy) {
  std::mt19937_64 random(20261132);
  Measurement rows = both(laser(random), tracker(random, 3));
  try {
    estimate_file_noise(machine(), rows);
    FAIL() << "nine readings for seven values";
  } catch (const text::InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("tracker.csv: the lengths of this file have no u"), std::string::npos) << what;
    EXPECT_NE(what.find("a column u[um], or <instrument u="), std::string::npos) << what;
  }
}

TEST(FileNoise, NothingIsEstimatedIfAllFilesOrNoFileStateU) {
  std::mt19937_64 random(20261133);
  Measurement stated = both(laser(random), tracker(random, 20, 1, ",u[um]", ",6"));
  EXPECT_TRUE(estimate_file_noise(machine(), stated).empty());
  Measurement unstated = parse_measurement(tracker(random, 20), "tracker.csv", machine());
  EXPECT_TRUE(estimate_file_noise(machine(), unstated).empty());
  EXPECT_EQ(unstated.uncertainty.maxCoeff(), 0);
}

TEST(FileNoise, WithoutAnyUInstrumentsThatDifferHaveTheirOwnNoise) {
  std::mt19937_64 random(20261135);
  Measurement rows = parse_measurement(tracker(random, 40), "tracker.csv", machine());
  append_measurement(rows, parse_measurement(runs(random), "runs.csv", machine()));
  const std::vector<FileNoise> noise = estimate_file_noise(machine(), rows);
  ASSERT_EQ(noise.size(), 2u);
  EXPECT_EQ(noise[0].source, FileNoise::Source::kFit);
  EXPECT_NEAR(noise[0].u, kTracker_mm, 0.5 * kTracker_mm) << "the model lacks the reversal of the laser";
  EXPECT_NEAR(noise[1].u, 0.5e-3, 3 * noise[1].std) << "the reversal of 14 um is not noise";
  EXPECT_NE(noise[1].sentence().find("the readings of other files have another scatter"), std::string::npos);
}

TEST(FileNoise, WithoutAnyUAlikeFilesKeepOneWeight) {
  std::mt19937_64 random(20261136);
  Measurement rows = parse_measurement(tracker(random, 30, 2), "tracker.csv", machine());
  append_measurement(rows, parse_measurement(tracker(random, 30, 2), "again.csv", machine()));
  append_measurement(rows, parse_measurement(tracker(random, 2), "short.csv", machine()));
  EXPECT_TRUE(estimate_file_noise(machine(), rows).empty());
  EXPECT_EQ(rows.uncertainty.maxCoeff(), 0);
}

TEST(FileNoise, CheckRowsAloneAreNoFileToEstimate) {
  std::mt19937_64 random(20261134);
  Measurement rows = both(laser(random), tracker(random, 20, 1, ",role", ",check"));
  EXPECT_TRUE(estimate_file_noise(machine(), rows).empty());
}

TEST(FileNoise, AComparisonTakesTheResidualOfTheGivenMachine) {
  std::mt19937_64 random(20261135);
  Measurement rows = both(laser(random), tracker(random, 75));
  const Eigen::VectorXd residual = residuals(machine(), rows);
  const std::vector<FileNoise> noise = file_noise_of_residual(rows, residual);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].source, FileNoise::Source::kGivenMachine);
  EXPECT_GT(noise[0].u, 1.2 * kTracker_mm) << "the squareness is part of it";
  EXPECT_GT(rows.uncertainty.minCoeff(), 0);
}

TEST(FileNoise, AnEffectThatExplainsTheResidualLowersTheEstimate) {
  std::mt19937_64 random(20261136);
  Measurement rows = both(laser(random), tracker(random, 75));
  Machine without = machine();
  for (Static& item : without.statics) item.hidden = true;  // neither squareness nor scale
  std::vector<FileNoise> noise = estimate_file_noise(without, rows);
  ASSERT_EQ(noise.size(), 1u);
  const double before = noise[0].u;
  EXPECT_GT(before, 1.1 * kTracker_mm);
  EXPECT_FALSE(estimate_file_noise_again(without, rows, noise));
  EXPECT_EQ(noise[0].u, before);
  EXPECT_TRUE(estimate_file_noise_again(machine(), rows, noise));
  EXPECT_NEAR(noise[0].u, kTracker_mm, 3 * noise[0].std);
  EXPECT_EQ(rows.uncertainty[static_cast<Eigen::Index>(rows.rows()) - 1], noise[0].u);
}

/// Heights with a bow that the model does not have.
std::string bowed(std::mt19937_64& random, double bow_mm) {
  std::normal_distribution<double> noise(0, 0.5e-3);
  std::string csv = "X[mm],Y[mm],Z[mm],z[mm],u[um],setup\n";
  for (int i = 0; i <= 8; ++i)
    for (int k = 0; k <= 5; ++k) {
      const double x = 100.0 * i, y = 100.0 * k;
      csv += fmt::format("{},{},-200,{:.6f},0.5,height\n", x, y,
                         -200 + bow_mm * std::pow(x / 400 - 1, 2) + noise(random));
    }
  return csv;
}

Measurement all_of(const std::vector<std::pair<std::string, std::string>>& files) {
  Measurement all = parse_measurement(files.front().second, files.front().first, machine());
  for (std::size_t i = 1; i < files.size(); ++i)
    append_measurement(all, parse_measurement(files[i].second, files[i].first, machine()));
  return all;
}

ParameterEstimate squareness_of(const FitResult& fitted) {
  for (const ParameterEstimate& one : fitted.estimates)
    if (one.name == "EC0Y") return one;
  return {};
}

TEST(FileFactors, AnErrorInOneFileTakesNoWeightFromTheOthers) {
  for (const double bow_mm : {0.1, 1.0, 10.0}) {
    std::mt19937_64 random(20261138);
    const std::string square = tracker(random, 12, 1, ",u[um],setup", ",6,tracker");
    const ParameterEstimate alone = squareness_of(fit::fit(machine(), all_of({{"square.csv", square}})));
    const Measurement rows = all_of({{"square.csv", square}, {"bed.csv", bowed(random, bow_mm)}});
    const FitResult together = fit::fit(machine(), rows);
    ASSERT_EQ(together.file_factors.size(), 2u);
    EXPECT_EQ(together.file_factors[0].factor, 1) << "chance explains its residual";
    // A parabola beside the best plane: 0.35 of its height, with stations every 100 mm.
    EXPECT_NEAR(together.file_factors[1].factor, 0.33 * bow_mm / 0.5e-3, 0.05 * bow_mm / 0.5e-3);
    const ParameterEstimate beside = squareness_of(together);
    EXPECT_NEAR(beside.value, alone.value, 0.05 * alone.std) << bow_mm;
    EXPECT_NEAR(beside.std, alone.std, 0.3 * alone.std) << bow_mm;
    EXPECT_GT(together.chi_square, 1e4) << "over the stated u";
    EXPECT_NE(together.file_factors[1].sentence().find("bed.csv: the model leaves"), std::string::npos);
  }
}

TEST(FileFactors, TheShapeOfOneFileMakesNoEstimateOfAnotherMoreCertain) {
  std::mt19937_64 random(20261141);
  const std::string square = tracker(random, 12, 1, ",u[um],setup", ",6,tracker");
  const ParameterEstimate alone = squareness_of(fit::fit(machine(), all_of({{"square.csv", square}})));
  std::string bed = bowed(random, 1);  // without u: its noise is what the model leaves
  for (const std::string u : {",u[um]", ",0.5"})
    for (std::size_t at = bed.find(u); at != std::string::npos; at = bed.find(u)) bed.erase(at, u.size());
  Measurement rows = all_of({{"square.csv", square}, {"bed.csv", bed}});
  ASSERT_EQ(estimate_file_noise(machine(), rows).size(), 1u);
  const FitResult together = fit::fit(machine(), rows);
  EXPECT_FALSE(together.noise.independent()) << "the bow looks like a drift";
  EXPECT_GT(squareness_of(together).std, 0.95 * alone.std);
}

TEST(FileFactors, FilesThatTheModelDescribesAlikeKeepTheStatedU) {
  std::mt19937_64 random(20261139);
  const std::string square = tracker(random, 30, 1, ",u[um],setup", ",6,tracker");
  const Measurement right = all_of({{"square.csv", square}, {"bed.csv", bowed(random, 0)}});
  EXPECT_TRUE(fit::fit(machine(), right).file_factors.empty());
  const Measurement bent = all_of({{"square.csv", square}, {"bed.csv", bowed(random, 1)}});
  FitOptions given;
  given.noise = NoiseModel{};
  EXPECT_TRUE(fit::fit(machine(), bent, given).file_factors.empty()) << "the caller has weighed the rows";
  EXPECT_TRUE(fit::fit(machine(), all_of({{"bed.csv", bowed(random, 1)}})).file_factors.empty());
}

}  // namespace
}  // namespace vernier::file_noise_test
