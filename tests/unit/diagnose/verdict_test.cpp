// SPDX-License-Identifier: GPL-3.0-or-later
// What the answer says, not only which one it is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/outliers.h"
#include "tools/fit/findings.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"

namespace vernier::verdict_test {

using namespace vernier::diagnose;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr std::uint64_t kSeed = 5;

const char* const kAxis = R"(<machine name="m"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X rotary="false" min="0" max="500"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+c" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)";

/// Reversal error of 20 um and an error of 6 um whose period shrinks along the axis: the one is in the
/// catalogue, the other is not.
std::string reversal_and_chirp() {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],dirX,x[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i < 100; ++i) {
      const double x = 5.0 * i + run, part = x / 500, dir = run % 2 == 0 ? 1 : -1;
      const double error = 0.01 * dir + 0.006 * std::sin(2 * 3.14159265358979 * 6 * part * part);
      text += fmt::format("{},{},{:.6f},1,r{}\n", x, dir, x + error + noise(random), run);
    }
  return text;
}

TEST(Verdict, UnexplainedSaysWhereTheRestFailsBehindALadder) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows = parse_measurement(reversal_and_chirp(), "m.csv", machine);

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, rows);

  ASSERT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_GE(answer.ladder.size(), 2U);
  ASSERT_FALSE(answer.left.findings.empty());
  EXPECT_NE(answer.explanation.find(answer.left.findings.front().sentence), std::string::npos)
      << answer.explanation;
}

/// A machine whose every parameter is known is a machine too.
TEST(Verdict, NeedsNoFreeParameter) {
  std::string fixed = kAxis;
  fixed.replace(fixed.find("<c value=\"0\""), 12, "<c Hide=\"true\" value=\"0\"");
  const Machine machine = parse_machine(fixed, "m.xml");
  for (const double backlash : {0.01, 0.0}) {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> noise(0, 0.001);
    std::string text = "X[mm],dirX,x[mm],u[um],run\n";
    for (int i = 0; i < 200; ++i) {
      const int dir = i % 2 == 0 ? 1 : -1;
      text +=
          fmt::format("{},{},{:.6f},1,r{}\n", 2.5 * i, dir, 2.5 * i + backlash * dir + noise(random), i % 4);
    }
    const Measurement rows = parse_measurement(text, "m.csv", machine);

    const Diagnosis answer = diagnose::diagnose(fixed, machine, rows);

    EXPECT_EQ(answer.verdict, backlash > 0 ? Verdict::kMissingEffect : Verdict::kConsistent)
        << "seed " << kSeed << ": " << answer.explanation;
    ASSERT_EQ(answer.ladder.size(), backlash > 0 ? 2U : 1U);
    EXPECT_EQ(answer.ladder.back().effect, backlash > 0 ? "backlash" : "");
  }
}

/// An error whose period shrinks along the axis, alike in all runs, at uneven places.
std::string chirp() {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::uniform_real_distribution<double> place(0, 500);
  std::string text = "X[mm],x[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i < 120; ++i) {
      const double x = place(random), part = x / 500;
      const double error = 0.004 * std::sin(2 * 3.14159265358979 * 6 * part * part);
      text += fmt::format("{:.3f},{:.6f},1,r{}\n", x, x + error + noise(random), run);
    }
  return text;
}

TEST(Verdict, NamesNothingWhereTheLadderIsPiecesOfOneFunction) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows = parse_measurement(chirp(), "m.csv", machine);

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, rows);

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_GE(answer.ladder.size(), 4U);
}

/// Two waves at one place are two effects: a screw and its encoder.
TEST(Verdict, TwoPeriodsOfOneAxisAreNamed) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::uniform_real_distribution<double> place(0, 500);
  std::string text = "X[mm],x[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i < 120; ++i) {
      const double x = place(random), turn = 2 * 3.14159265358979 * x;
      const double error = 0.004 * std::sin(turn / 40) + 0.003 * std::sin(turn / 17);
      text += fmt::format("{:.3f},{:.6f},1,r{}\n", x, x + error + noise(random), run);
    }
  const Machine machine = parse_machine(kAxis, "m.xml");

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_EQ(answer.ladder.size(), 3U);
  EXPECT_EQ(answer.ladder[1].effect, "cyclic-error");
  EXPECT_EQ(answer.ladder[2].effect, "cyclic-error");
}

/// A survey of one axis, four runs of 120 rows at the places that `place` gives, noise 1 um. `error`: mm, of
/// place in mm and temperature in degC.
std::string survey(const std::function<double(int)>& place,
                   const std::function<double(double, double)>& error) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],T[degC],x[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i < 120; ++i) {
      const double x = place(i), warm = 20 + 2 * run + 0.02 * i;
      text += fmt::format("{:.3f},{:.3f},{:.6f},1,r{}\n", x, warm, x + error(x, warm) + noise(random), run);
    }
  return text;
}

/// Places all over the axis, no two alike.
std::function<double(int)> anywhere() {
  auto random = std::make_shared<std::mt19937_64>(kSeed + 1);
  return [random](int) { return std::uniform_real_distribution<double>(0, 500)(*random); };
}

/// A wave whose height changes along the axis: two periods that the axis is too short to tell apart.
TEST(Verdict, TwoPeriodsThatTheAxisDoesNotResolveAreNotNamed) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const std::string text = survey(anywhere(), [](double x, double) {
    const double turn = 2 * 3.14159265358979 * x;
    return 0.006 * std::sin(turn / 40) + 0.006 * std::sin(turn / 42.6);
  });

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_GE(answer.ladder.size(), 3U);
}

/// A function of X alone, which a table of 17 stations follows: it takes the error away, and is no smooth
/// curve.
TEST(Verdict, ACurveFasterThanSmoothIsNotNamed) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const std::string text = survey(anywhere(), [](double x, double) {
    return 0.0015 * std::sin(2 * 3.14159265358979 * 4.1 * (x / 500) * (x / 500) + 0.7);
  });

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_NE(answer.explanation.find("shorter than those of a smooth curve"), std::string::npos)
      << answer.explanation;
  ASSERT_GE(answer.ladder.size(), 2U);
  EXPECT_EQ(answer.ladder[1].effect, "positioning-error");
}

TEST(Verdict, ASmoothCurveThatIsNoneOfTheFormsIsNamed) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const std::string text = survey(anywhere(), [](double x, double) {
    const double part = (x / 500 - 0.4) / 0.16;
    return 0.008 * std::exp(-part * part);
  });

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.at(1).effect, "positioning-error");
}

const char* const kTableOfNine = R"(<machine name="m"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X rotary="false" min="0" max="500"/></machineaxes>
  <comptables><table axis="X" fit="X"><station loc="0"/><station loc="62.5"/><station loc="125"/>
  <station loc="187.5"/><station loc="250"/><station loc="312.5"/><station loc="375"/><station loc="437.5"/>
  <station loc="500"/></table></comptables></variables>
  <transforms branch="tool"><sixdof n="1" X="X+lXx" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)";

/// Twelve places and a free table of nine stations: three functions of X are left, and any curve fits them.
TEST(Verdict, ACurveThatNothingCouldRefuteIsNotNamed) {
  const Machine machine = parse_machine(kTableOfNine, "m.xml");
  const std::string text = survey(
      [](int i) { return 500.0 / 11 * (i % 12); },
      [](double x, double) { return 0.02 * std::sin(2 * 3.14159265358979 * 6 * (x / 500) * (x / 500)); });

  const Diagnosis answer =
      diagnose::diagnose(kTableOfNine, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
}

/// Thermal growth, in proportion to the place or bent over it.
std::string growth(double bent) {
  return survey(anywhere(), [bent](double x, double warm) {
    const double part = x / 500;
    return 0.0025 * (part - bent * part * part) * (warm - 20);
  });
}

TEST(Verdict, ANameThatDoesNotHoldAlongTheAxisIsNotGiven) {
  const Machine machine = parse_machine(kAxis, "m.xml");

  const Diagnosis straight =
      diagnose::diagnose(kAxis, machine, parse_measurement(growth(0), "m.csv", machine));
  const Diagnosis bent = diagnose::diagnose(kAxis, machine, parse_measurement(growth(0.3), "m.csv", machine));

  EXPECT_EQ(straight.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << straight.explanation;
  EXPECT_EQ(straight.ladder.at(1).effect, "thermal-scale");
  EXPECT_EQ(bent.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << bent.explanation;
  EXPECT_NE(bent.explanation.find("changes along the axes"), std::string::npos) << bent.explanation;
}

/// A jump is a function of the axis, too, and no smooth one.
TEST(Verdict, AJumpIsNoSmoothCurve) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const std::string text = survey(anywhere(), [](double x, double) { return x > 210 ? 0.0025 : 0.0; });

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_NE(answer.explanation.find("a jump at the axis position 2"), std::string::npos)
      << answer.explanation;
}

/// One lost reading among many, and reversal error in all the others.
TEST(Verdict, AGrossOutlierDoesNotHideACause) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  for (const double off : {0.7, 0.1}) {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> noise(0, 0.001);
    std::string text = "X[mm],dirX,x[mm],u[um],run\n";
    for (int i = 0; i < 200; ++i) {
      const int dir = i % 2 == 0 ? 1 : -1;
      const double lost = i == 77 ? off : 0;
      text += fmt::format("{},{},{:.6f},1,r{}\n", 2.5 * i, dir, 2.5 * i + 0.002 * dir + lost + noise(random),
                          i / 50);
    }

    const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

    EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
    EXPECT_EQ(answer.ladder.back().effect, "backlash");
    EXPECT_NE(answer.explanation.find("line 79"), std::string::npos) << answer.explanation;
  }
}

/// Four runs of 100 rows, every fifth a check row, with reversal error. `off`: further error of a row, mm.
Measurement rows_with(const std::function<double(int)>& off, const Machine& machine) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],dirX,x[mm],u[um],run,role\n";
  for (int i = 0; i < 400; ++i) {
    const double x = 5.0 * (i % 100), dir = (i / 3) % 2 == 0 ? 1 : -1;
    text += fmt::format("{},{},{:.6f},1,r{},{}\n", x, dir, x + 0.002 * dir + off(i) + noise(random), i / 100,
                        i % 5 == 4 ? "check" : "fit");
  }
  return parse_measurement(text, "m.csv", machine);
}

/// Missing-effect before, with eight "outliers": the check figure was that of the other rows.
TEST(Verdict, RowsThatStepTogetherAreNoOutliers) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  // The base moves within the first run: at line 94, eight rows before the second run.
  const Measurement rows = rows_with([](int i) { return i >= 92 ? 0.03 : 0.0; }, machine);

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, rows);

  EXPECT_NE(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  // Of the rows that differ (line 94), or of the noise model, whose steps are a few rows beside.
  EXPECT_NE(answer.explanation.find("a step at line "), std::string::npos) << answer.explanation;
  EXPECT_FALSE(answer.left_out.has_value());
}

TEST(Verdict, TheErrorOfAllCheckRowsIsStatedBesideOutliers) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows = rows_with([](int i) { return i == 44 || i == 301 ? 0.5 : 0.0; }, machine);

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, rows);

  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_TRUE(answer.left_out.has_value());
  EXPECT_EQ(answer.left_out->rows, 2U);
  EXPECT_EQ(answer.left_out->check_rows, 1U);
  // One of 80 check rows is off by 500 um: 500 / sqrt(80) = 56 um, beside noise of 1 um.
  EXPECT_NEAR(answer.left_out->check_rms_um.value_or(0), 56, 1);
  EXPECT_LT(answer.ladder.back().check_rms_um.value_or(99), 2);
  EXPECT_NE(answer.explanation.find("1 check row is left out"), std::string::npos) << answer.explanation;
}

/// The error of the previous motion is in no column. Named as backlash before, without one row of twelve.
TEST(Verdict, RowsThatDependOnThePreviousMotionAreNoOutliers) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],dirX,x[mm],u[um],run,role\n";
  const auto dir_of = [](int i) { return i / 12 % 2 == 0 ? 1 : -1; };
  for (int i = 0; i < 400; ++i) {
    const double x = 5.0 * (i * 37 % 100);
    const double error = 0.006 * dir_of(std::max(0, i - 1));
    text += fmt::format("{},{},{:.6f},1,r{},{}\n", x, dir_of(i), x + error + noise(random), i / 100,
                        i % 5 == 4 ? "check" : "fit");
  }

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_FALSE(answer.left_out.has_value()) << answer.explanation;
}

/// No instrument drifts from row to row by three times its uncertainty.
TEST(Verdict, ADriftFromRowToRowLeavesNoName) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  for (const double rows : {1.5, 40.0}) {
    const double keep = std::exp(-1 / rows);
    std::vector<double> drift(400);
    for (std::size_t i = 1; i < drift.size(); ++i)
      drift[i] = keep * drift[i - 1] + 0.003 * std::sqrt(1 - keep * keep) * normal(random);
    const Measurement survey = rows_with(
        [&](int i) { return drift[static_cast<std::size_t>(i)] + (i / 3 % 2 == 0 ? 0.002 : -0.002); },
        machine);

    const Diagnosis answer = diagnose::diagnose(kAxis, machine, survey);

    const bool quick = rows < 3;
    EXPECT_EQ(answer.verdict, quick ? Verdict::kUnexplained : Verdict::kMissingEffect)
        << "seed " << kSeed << ", " << rows << " rows: " << answer.explanation;
    EXPECT_EQ(answer.explanation.find("An error that changes from row to row remains") == 0, quick)
        << answer.explanation;
  }
}

/// A thermometer far from the motor follows the motor's heat only in part: the growth by this thermometer and
/// a warm-up in time are parts of one response.
TEST(Verdict, AWarmUpBesideAGrowthIsHeatThatNoThermometerRecords) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string rows = "t[s],X[mm],x[mm],u[um],T_room[degC],run,role\n";
  for (int i = 0; i < 400; ++i) {
    const double x = 5.0 * (i * 37 % 100), t = 30.0 * i, room = 20 + 2 * std::sin(t / 900);
    const double error = 0.02 * (1 - std::exp(-t / 1800)) + 0.004 * (room - 20);
    rows += fmt::format("{},{},{:.6f},1,{:.4f},r{},{}\n", t, x, x + error + noise(random), room, i / 100,
                        i % 5 == 4 ? "check" : "fit");
  }

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(rows, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_NE(answer.explanation.find("that no thermometer records"), std::string::npos) << answer.explanation;
}

TEST(Verdict, ExcludedCheckRowsCountUpToTheLimitOfAnOutlier) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows = rows_with([](int) { return 0.0; }, machine);
  const VerdictThresholds thresholds;
  Eigen::VectorXd before = Eigen::VectorXd::Constant(400, 0.002), after = before / 2;
  EXPECT_FALSE(is_worse_on_check_rows(rows, before, rows, after, thresholds));
  // A true outlier of 300 u in one check row, larger by 100 um with the second model: still better.
  before[4] = 0.3;
  after[4] = 0.4;
  EXPECT_FALSE(is_worse_on_check_rows(rows, before, rows, after, thresholds));
  // Seven of 80 check rows become outliers: 7 * (36 - 4) is more than 73 * (4 - 1).
  for (int i = 9; i < 44; i += 5) after[i] = 0.01;
  EXPECT_TRUE(is_worse_on_check_rows(rows, before, rows, after, thresholds));
}

TEST(Verdict, WithoutUAndRepeatsNothingStatesTheNoise) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  for (const bool with_u : {true, false}) {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> noise(0, 0.1);
    std::string text = with_u ? "X[mm],x[mm],u[mm]\n" : "X[mm],x[mm]\n";
    for (int i = 0; i < 60; ++i)
      text += fmt::format("{},{:.6f}{}\n", 8.3 * i, 8.3 * i + noise(random), with_u ? ",0.1" : "");

    const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

    EXPECT_EQ(answer.verdict, Verdict::kConsistent) << "seed " << kSeed << ": " << answer.explanation;
    EXPECT_EQ(answer.explanation.find("The residual is noise") == 0, with_u) << answer.explanation;
    EXPECT_EQ(answer.explanation.find("have no u and no repeats") == std::string::npos, with_u);
  }
}

TEST(Verdict, RepeatsInOtherRunsHaveTheRemedyOfTheFit) {
  // GIVEN runs that repeat their targets, without a column setup
  const Machine machine = parse_machine(kAxis, "m.xml");
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string without = "X[mm],x[mm],run\n", with = "X[mm],x[mm],run,setup\n";
  for (int run = 1; run <= 5; ++run)
    for (int i = 0; i < 12; ++i) {
      const std::string row = fmt::format("{},{:.6f},{}", 40 * i, 40 * i + noise(random), run);
      without += row + "\n";
      with += row + ",1\n";
    }
  const auto explanation = [&](const std::string& text) {
    return diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine)).explanation;
  };
  // THEN the diagnosis explains the unknown noise as the fit does, and the column makes the noise known
  EXPECT_NE(explanation(without).find(fit::kRepeatsInOtherRuns), std::string::npos) << explanation(without);
  EXPECT_EQ(explanation(without).find("no repeats"), std::string::npos);
  EXPECT_EQ(explanation(with).find("set-up of its own"), std::string::npos) << explanation(with);
}

TEST(Verdict, ChanceOfSuccessiveRowsIsThatOfTheRunsTest) {
  // Two of four rows: three of the six pairs are neighbours.
  EXPECT_NEAR(std::exp(log_p_of_groups(4, 2, 1)), 0.5, 1e-12);
  EXPECT_NEAR(std::exp(log_p_of_groups(4, 2, 2)), 1, 1e-12);
  // Six successive rows of 300: 295 of C(300, 6) = 962822846700 sets.
  EXPECT_NEAR(log_p_of_groups(300, 6, 1), std::log(295 / 962822846700.0), 1e-9);
}

TEST(Verdict, RowsOutOfTheOrderOfTimeAreToldWithTheirLine) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows =
      parse_measurement("X[mm],t[s],x[mm],run\n0,0,0,a\n1,5,1,a\n0,1,0,b\n2,4,2,a\n", "m.csv", machine);
  try {
    diagnose::diagnose(kAxis, machine, rows);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("m.csv:5: \"t\": falls from 5 to 4"), 0U) << error.what();
  }
}

/// An axis and a turning table under it, both read in x and y.
const char* const kTable = R"(<machine name="m"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X min="0" max="500"/><C rotary="true" min="0" max="360"/></machineaxes></variables>
  <transforms branch="workpiece"><sixdof n="1" rZ="C"/></transforms>
  <transforms branch="tool"><sixdof n="1" X="X+c"/></transforms></machine>)";

/// Readings of kTable; `turned`: of C; `unit`: what 1 mm is written as.
std::string survey_of_table(double turned, double unit) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::uniform_real_distribution<double> place(0, 500), angle(0, 360);
  std::string text = "X[mm],C[deg],x[mm],y[mm],u[um],run\n";
  for (int i = 0; i < 240; ++i) {
    const double x = place(random), c = angle(random), turn = -turned * c * 3.14159265358979 / 180;
    text +=
        fmt::format("{:.3f},{:.3f},{:.6f},{:.6f},1,r{}\n", x, c, unit * (x * std::cos(turn) + noise(random)),
                    unit * (x * std::sin(turn) + noise(random)), i % 4);
  }
  return text;
}

TEST(Verdict, ReadingsThatAFitRefusesByNameAreTheInstrumentsAndNothingIsSearched) {
  const Machine machine = parse_machine(kTable, "m.xml");
  const auto answer_of = [&](double turned, double unit) {
    return diagnose::diagnose(kTable, machine,
                              parse_measurement(survey_of_table(turned, unit), "m.csv", machine));
  };

  const Diagnosis good = answer_of(1, 1);
  EXPECT_EQ(good.verdict, Verdict::kConsistent) << good.explanation;
  EXPECT_EQ(good.end.absurd, "");

  const Diagnosis metres = answer_of(1, 0.001);
  EXPECT_EQ(metres.verdict, Verdict::kInstrument) << metres.explanation;
  EXPECT_NE(metres.explanation.find("a thousand times too"), std::string::npos) << metres.explanation;
  EXPECT_TRUE(metres.candidates.empty());
  EXPECT_FALSE(metres.end.absurd.empty());

  const Diagnosis other_way = answer_of(-1, 1);
  EXPECT_EQ(other_way.verdict, Verdict::kInstrument) << other_way.explanation;
  EXPECT_NE(other_way.explanation.find("sign"), std::string::npos) << other_way.explanation;
}

/// An arm that leans, whose statics have no nominal: at the fitted lean gravity acts about the upright joint,
/// in the nominal chain it does not.
TEST(Verdict, CandidatesOfAChainWithoutNominalValuesAreThoseOfItsStart) {
  const char* const arm = R"(<machine name="arm" gravity="0 0 -1"><variables><static>
    <lean value="0" unit="deg"/><l2 value="400" unit="mm"/><l3 value="300" unit="mm"/></static>
    <machineaxes><J1 rotary="true" min="-170" max="170"/><J2 rotary="true" min="-90" max="90"/>
    <J3 rotary="true" min="-120" max="120"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" Z="200" rX="lean"/><sixdof n="2" rZ="J1"/><sixdof n="3" rY="J2"/>
    <sixdof n="4" Z="l2" rY="J3"/><sixdof n="5" Z="l3"/></transforms></machine>)";
  const Machine machine = parse_machine(arm, "arm.xml");
  Machine truth = machine;
  truth.statics[0].value = 0.3;
  truth.statics[1].value = 400.4;
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.01);
  States states = make_states(200, truth);
  for (std::size_t a = 0; a < 3; ++a)
    for (double& q : states.axis[a])
      q = std::uniform_real_distribution<double>(*truth.axes[a].min, *truth.axes[a].max)(random);
  const Eigen::Matrix3Xd p = forward(truth, states).position;
  std::string text = "J1[deg],J2[deg],J3[deg],x[mm],y[mm],z[mm],run\n";
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    // A joint that gives way under the arm, and one that does so about the upright.
    const double sag = 0.2 * std::sin((states.axis[1][i] + states.axis[2][i]) * 3.14159265358979 / 180);
    text += fmt::format("{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},r{}\n", states.axis[0][i],
                        states.axis[1][i], states.axis[2][i], p(0, i) + noise(random),
                        p(1, i) + sag + noise(random), p(2, i) + sag + noise(random), i % 4);
  }
  const Measurement rows = parse_measurement(text, "arm.csv", machine);

  Diagnosis answer;
  ASSERT_NO_THROW(answer = diagnose::diagnose(arm, machine, rows)) << "seed " << kSeed;

  EXPECT_EQ(answer.base.machine.statics[0].nominal, 0.0);
  EXPECT_EQ(parse_machine(answer.machine_text, "arm.xml").statics[0].nominal, 0.0);
}

/// Without u the noise itself has a length: what is said of the rest is in um, as the tables beside it have
/// it.
TEST(Verdict, SizesInTheExplanationAreLengthsWithoutUToo) {
  std::string text = reversal_and_chirp();
  for (auto at = text.find(",1,r"); at != std::string::npos; at = text.find(",1,r", at + 2))
    text.erase(at, 2);
  text.replace(text.find(",u[um]"), 6, "");
  const Machine machine = parse_machine(kAxis, "m.xml");

  const Diagnosis answer = diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  double largest_um = 0;
  for (const residual::Finding& finding : answer.left.findings)
    largest_um = std::max({largest_um, finding.rms_um, std::abs(finding.low_um), finding.high_um});
  ASSERT_FALSE(answer.left.findings.empty()) << answer.explanation;
  EXPECT_LT(largest_um, 30) << answer.explanation;  // the errors are 10 and 6 um
}

}  // namespace
}  // namespace vernier::verdict_test
