// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/positioning.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "tools/evaluate/positioning_page.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::positioning_test {

using namespace vernier::evaluate;
using namespace vernier::text;
namespace {

const std::string kData = std::string(VERNIER_SOURCE_DIR) + "/tests/data/iso230_2/ecmc.csv";

PositioningResult published() {
  return evaluate_positioning(read_positioning(read_file(kData), kData, "X", "x").readings);
}

/// As the report prints: rounded to 1e-8 mm, and so compared to half of that.
constexpr double kDigit = 0.5e-8 + 1e-12;

TEST(Positioning, TargetsAreThePublishedOnes) {
  const PositioningResult result = published();
  ASSERT_EQ(result.targets.size(), 5u);
  // Columns of the report: means (1e-8), reversal, then s, R of both senses and R_i (which it prints to
  // 1e-8).
  const double kForward[] = {-9.242e-05, -9.162e-05, -8.482e-05, -8.902e-05, -0.00010942};
  const double kBackward[] = {-9.202e-05, -0.00010122, -9.082e-05, -8.862e-05, -0.00012162};
  const double kBoth[] = {-9.222e-05, -9.642e-05, -8.782e-05, -8.882e-05, -0.00011552};
  const double kReversal[] = {-4e-07, 9.6e-06, 6e-06, -4e-07, 1.22e-05};
  const double kSpread[2][5] = {{8.79e-06, 6.77e-06, 7.26e-06, 9e-06, 1.258e-05},
                                {6.28e-06, 7.29e-06, 1.043e-05, 1.218e-05, 1.573e-05}};
  const double kRepeatability[2][5] = {{3.517e-05, 2.707e-05, 2.904e-05, 3.6e-05, 5.033e-05},
                                       {2.514e-05, 2.918e-05, 4.17e-05, 4.871e-05, 6.29e-05}};
  const double kBothRepeat[] = {3.517e-05, 3.772e-05, 4.17e-05, 4.871e-05, 6.882e-05};
  for (std::size_t i = 0; i < 5; ++i) {
    const TargetResult& at = result.targets[i];
    EXPECT_NEAR(at.mean[0], kForward[i], kDigit) << i;
    EXPECT_NEAR(at.mean[1], kBackward[i], kDigit) << i;
    EXPECT_NEAR(at.mean_both, kBoth[i], kDigit) << i;
    EXPECT_NEAR(at.reversal, kReversal[i], kDigit) << i;
    EXPECT_NEAR(at.repeatability_both, kBothRepeat[i], kDigit) << i;
    for (std::size_t sense = 0; sense < 2; ++sense) {
      EXPECT_NEAR(at.spread[sense], kSpread[sense][i], kDigit) << i;
      EXPECT_NEAR(at.repeatability[sense], kRepeatability[sense][i], kDigit) << i;
    }
  }
}

TEST(Positioning, CharacteristicsAreThePublishedOnes) {
  const PositioningResult result = published();
  const auto is = [&](const char* name, double printed) {
    ASSERT_TRUE(characteristic(result, name)) << name;
    EXPECT_NEAR(*characteristic(result, name), printed, kDigit) << name;
  };
  is("B", 1.22e-05);
  is("mean B", 5.4e-06);
  is("R+", 5.033e-05);
  is("R-", 6.29e-05);
  is("E+", 2.46e-05);
  is("E-", 3.3e-05);
  is("M", 2.77e-05);
  is("A+", 6.428e-05);
  is("A-", 8.881e-05);
  is("A", 8.881e-05);
  // By the standard's text where the report has words of its own: tests/data/iso230_2/README.md.
  is("R", 6.882e-05);
  is("E", 3.68e-05);
}

TEST(Positioning, OneSenseHasNoReversal) {
  const PositioningResult result = evaluate_positioning(
      read_positioning("X[mm],x[um],dirX\n0,1,1\n10,10002,1\n0,3,1\n10,10002,1\n", "s.csv", "X", "x")
          .readings);
  EXPECT_FALSE(result.reversal);
  EXPECT_FALSE(result.accuracy_both);
  EXPECT_NEAR(*result.systematic[0], 0, 1e-12);
  EXPECT_NEAR(*result.repeatability[0], 4 * std::sqrt(2.0) * 1e-3, 1e-9);
}

TEST(Positioning, ReadingsWithoutADirectionAreCounted) {
  const PositioningFile file = read_positioning(
      "X[mm],x[mm],dirX\n0,0.001,0\n10,10.001,1\n20,20.001,1\n0,0.002,0\n10,10.003,1\n20,,0\n", "s.csv", "X",
      "x");
  EXPECT_EQ(file.undirected, 2u);
  EXPECT_EQ(file.rows, 3u);
}

TEST(Positioning, SenseComesFromTheOrderOfTheRowsToo) {
  // Up, the far end again from beyond, down, and once more.
  const PositioningFile file = read_positioning(
      "X[mm],x[mm]\n0,0.001\n10,10.001\n20,20.001\n20,20.003\n10,10.003\n0,0.003\n0,0.001\n10,10.001\n20,20."
      "001\n20,20.003\n10,10.003\n"
      "0,0.003\n",
      "s.csv", "X", "x");
  EXPECT_TRUE(file.sense_from_order);
  const PositioningResult result = evaluate_positioning(file.readings);
  EXPECT_NEAR(*result.reversal, 0.002, 1e-12);
  EXPECT_NEAR(*result.mean_reversal, -0.002, 1e-12);
  EXPECT_EQ(result.targets[1].count, (std::array<std::size_t, 2>{2, 2}));
}

TEST(Positioning, AConstantBetweenInstrumentAndAxisPlaysNoPart) {
  PositioningFile file = read_positioning(read_file(kData), kData, "X", "x");
  for (TargetReadings& target : file.readings)
    for (auto& list : target.deviation)
      for (double& value : list) value += 812.5;
  EXPECT_NEAR(*evaluate_positioning(file.readings).accuracy_both, 8.881e-05, 1e-7);
}

TEST(Positioning, RefusesWhatItCannotJudge) {
  const auto refused = [](const char* text, const char* axis, const char* reading) {
    try {
      evaluate_positioning(read_positioning(text, "s.csv", axis, reading).readings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused("X[mm],x[mm]\n0,0\n", "Y", "x").find("\"Y\": this column is missing"), std::string::npos);
  EXPECT_NE(refused("X[mm],x[deg]\n0,0\n", "X", "x").find("another dimension"), std::string::npos);
  EXPECT_NE(refused("X[mm],x[mm],dirX\n0,0,1\n1,1,1\n", "X", "x").find("one reading at 0 forward"),
            std::string::npos);
  EXPECT_NE(refused("X[mm],x[mm],dirX\n0,0,1\n0,0,1\n", "X", "x").find("two targets"), std::string::npos);
  EXPECT_NE(refused("X[mm],x[mm],dirX\n0,0,1\n0,0,2\n", "X", "x").find("an approach direction is 1 or -1"),
            std::string::npos);
}

TEST(Positioning, ReadsTheAngleAboutARotaryAxis) {
  const PositioningFile file =
      read_positioning("C[deg],rz[deg],dirC\n0,0.001,1\n90,90.002,1\n", "c.csv", "C", "c");
  ASSERT_EQ(file.readings.size(), 2u);
  EXPECT_NEAR(file.readings[1].deviation[0].at(0), 0.002, 1e-12);
}

TEST(Conformity, UncertaintyDecidesForNobody) {
  EXPECT_EQ(conformity(8, 10, 1), Conformity::kMet);
  EXPECT_EQ(conformity(9, 10, 1), Conformity::kMet);
  EXPECT_EQ(conformity(9.5, 10, 1), Conformity::kUndecided);
  EXPECT_EQ(conformity(10.5, 10, 1), Conformity::kUndecided);
  EXPECT_EQ(conformity(11.5, 10, 1), Conformity::kNotMet);
}

TEST(Conformity, PrintedNumbersSayWhatTheVerdictSays) {
  // Once "12.099 … tolerance 12.1: not met".
  const JudgedText text = judged_text({"A", 12.0991, {}, 12.0985}, 3);
  EXPECT_LT(*parse_number(text.tolerance), *parse_number(text.value)) << text.value << " " << text.tolerance;
  EXPECT_EQ(judged_text({"A", 12.0999, {}, 12.0998}, 3).value, "12.0999");
  EXPECT_EQ(judged_text({"A", 12.0999, {}, 12.0998}, 3).tolerance, "12.0998");
  EXPECT_EQ(judged_text({"A", 3, 0.5, 10}, 2).uncertainty, "0.50");
  EXPECT_EQ(judged_text({"A", {}, {}, 10}, 2).value, "–");
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> near(0, 1e-4);
  for (int i = 0; i < 2000; ++i) {
    const double tolerance = 10 + near(random), value = 9.5 + near(random), u = 0.5 + near(random);
    const JudgedText three = judged_text({"A", value, u, tolerance}, 3);
    EXPECT_EQ(conformity(*parse_number(three.value), *parse_number(three.tolerance),
                         *parse_number(three.uncertainty)),
              conformity(value, tolerance, u))
        << value << " " << u << " " << tolerance << " seed 7";
  }
}

TEST(Conformity, SameNumbersInAnotherUnitAreEqual) {
  EXPECT_EQ(conformity(0.1 + 0.2, 0.3, 0), Conformity::kMet);
  EXPECT_THROW(conformity(std::nan(""), 1, 0), std::logic_error);
}

TEST(Conformity, AssuranceHoldsWhereEveryToleranceIsMet) {
  EXPECT_TRUE(assurance_of({{"A", 3, 0.5, 10}, {"R", 2, {}, 2}}, "um").holds());
  EXPECT_FALSE(assurance_of({{"A", 9.8, 0.5, 10}}, "um").holds()) << "not decided";
  EXPECT_FALSE(assurance_of({{"A", {}, {}, 10}}, "um").holds()) << "not measured";
  EXPECT_FALSE(assurance_of({}, "um").holds()) << "nothing judged";
  EXPECT_EQ(assurance_of({{"R", 2, {}, 2}}, "um").uncovered().size(), 1u);
}

TEST(EvaluateCommand, WritesNumbersReportAndVerdict) {
  namespace fs = std::filesystem;
  const std::string folder = testing::TempDir() + "evaluate_" + std::to_string(getpid());
  fs::create_directories(folder);
  const auto run = [&](const std::string& words) {
    const int status = std::system(("cd '" + folder + "' && " VERNIER_BIN_DIR "/vernier evaluate iso230-2 " +
                                    kData + " --axis X " + words + " >out.txt 2>&1")
                                       .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(run("--json r.json -o r.html --header 'serial number=4711' --tolerance A=0.1um --uncertainty "
                "A=0.005um"),
            0)
      << read_file(folder + "/out.txt");
  const auto json = nlohmann::json::parse(read_file(folder + "/r.json"));
  EXPECT_EQ(json["characteristics"][0]["name"], "A");
  EXPECT_NEAR(json["characteristics"][0]["value"].get<double>(), 0.08881, 1e-5);
  EXPECT_EQ(json["characteristics"][0]["conformity"], "met");
  EXPECT_NE(read_file(folder + "/r.html").find("4711"), std::string::npos);
  EXPECT_TRUE(json["assurance"]["holds"]);
  EXPECT_EQ(json["assurance"]["because"][0]["rule"], "tolerance-A");
  EXPECT_EQ(run("--tolerance A=0.08um --uncertainty A=0.005um"), 2);
  EXPECT_EQ(run("--tolerance A=0.09um --uncertainty A=0.005um"), 0) << "undecided is no failure";
  EXPECT_EQ(run("--tolerance A=much"), 1);
  // One sense has no A: what was asked for is not judged, and that is no "met".
  write_file(folder + "/one.csv", "X[mm],x[mm],dirX\n0,0,1\n0,0.001,1\n9,9,1\n9,9.001,1\n");
  const int status = std::system(
      ("cd '" + folder +
       "' && " VERNIER_BIN_DIR "/vernier evaluate iso230-2 one.csv --axis X --tolerance A=50um >out.txt 2>&1")
          .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_NE(read_file(folder + "/out.txt").find("A cannot be compared with its tolerance"),
            std::string::npos);
  fs::remove_all(folder);
}

TEST(PositioningPage, EnvelopeOfTheMeansIsTheAccuracyAndEveryRunIsAPoint) {
  const PositioningFile file = read_positioning(read_file(kData), kData, "X", "x");
  PositioningWords words;
  words.axis = "X";
  const auto json = positioning_json(evaluate_positioning(file.readings), file, words);
  double low = 1e9, high = -1e9;
  std::size_t points = 0, dashed = 0;
  const auto page = positioning_page(json, words);
  for (const auto& section : page["sections"])
    if (section.contains("plots"))
      for (const auto& curve : section["plots"][0]["y"]) {
        const std::string style = curve.value("style", "");
        dashed += style == "dashed" ? 1 : 0;
        for (const auto& value : curve["values"]) {
          if (value.is_null()) continue;
          points += style == "points" ? 1 : 0;
          if (style != "dashed") continue;
          low = std::min(low, value.get<double>());
          high = std::max(high, value.get<double>());
        }
      }
  EXPECT_EQ(dashed, 4u);
  EXPECT_EQ(points, 5u * 5u * 2u);  // targets, runs, directions
  EXPECT_EQ(json["characteristics"][0]["name"], "A");
  EXPECT_NEAR(high - low, json["characteristics"][0]["value"].get<double>(), 1e-9);
}

}  // namespace
}  // namespace vernier::positioning_test
