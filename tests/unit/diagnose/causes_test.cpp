// SPDX-License-Identifier: GPL-3.0-or-later
// The set of causes that the data do not reject, and the decision between them by full fits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tools/diagnose/causes.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/refit.h"
#include "tools/model/machine_reader.h"

namespace vernier::causes_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 17;

const char* const kAxis = R"(<machine name="m"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X min="0" max="600"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+c"/></transforms></machine>)";

/// Rows of X in runs of 41 positions, forth and back, with an error and noise of 1 um. `cells`: of more
/// columns, by run and row of the run.
std::string runs_of(int runs, const std::function<double(double x, int sense, int run, int row)>& error_mm,
                    const std::string& columns = "",
                    const std::function<std::string(int run, int row)>& cells = {}) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],dirX,x[mm],u[um],run" + columns + "\n";
  for (int run = 0; run < runs; ++run)
    for (int row = 0; row < 82; ++row) {
      const int sense = row < 41 ? 1 : -1;
      const double x = 15.0 * (row < 41 ? row : 81 - row);
      text +=
          fmt::format("{},{},{:.6f},1,r{}{}\n", x, sense, x + error_mm(x, sense, run, row) + noise(random),
                      run, cells ? cells(run, row) : "");
    }
  return text;
}

struct Survey {
  Machine machine;
  Measurement rows;
  explicit Survey(const std::string& text)
      : machine(parse_machine(kAxis, "m.xml")), rows(parse_measurement(text, "m.csv", machine)) {}
};

Diagnosis diagnosed(const std::string& text) {
  static const DiagnoseOptions options;  // answers point into its effects
  const Survey survey(text);
  return diagnose::diagnose(kAxis, survey.machine, survey.rows, options);
}

std::vector<std::string> effects_of(const Diagnosis& answer) {
  std::vector<std::string> names;
  for (const Cause& cause : answer.causes)
    names.push_back(cause.candidate ? cause.candidate->choice.effect->id : "instrument " + cause.kind);
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TEST(Causes, AreOneForAMissingEffectAndNoneInNoise) {
  for (const double backlash : {0.01, 0.0}) {
    const Diagnosis answer =
        diagnosed(runs_of(4, [&](double, int sense, int, int) { return backlash / 2 * sense; }));
    EXPECT_EQ(answer.verdict, backlash > 0 ? Verdict::kMissingEffect : Verdict::kConsistent)
        << "seed " << kSeed << ": " << answer.explanation;
    ASSERT_EQ(answer.causes.size(), backlash > 0 ? 1U : 0U);
    EXPECT_TRUE(answer.remaining.is_noise);
    EXPECT_NEAR(answer.remaining.chi_square_per_freedom, 1, 0.35);  // 328 rows: std 0.08
    if (backlash <= 0) continue;
    EXPECT_EQ(effects_of(answer), std::vector<std::string>{"backlash"});
    EXPECT_EQ(answer.causes[0].add, answer.ladder.at(1).add);
    // Half of n ln(chi^2 / n), n = 328 rows, chi^2 / n = 1 + (5 um / 1 um)^2. The prices are below a tenth.
    EXPECT_NEAR(answer.causes[0].evidence, 164 * std::log(26), 53);
  }
}

TEST(Causes, HaveEachPeriodThatThePositionsDoNotDistinguish) {
  const auto screw = [](double x, int, int, int) {
    return 0.006 * std::sin(2 * std::numbers::pi * x / 10 + 0.4);
  };
  const Diagnosis answer = diagnosed(runs_of(4, screw));  // positions every 15 mm
  ASSERT_EQ(answer.verdict, Verdict::kAmbiguous) << answer.explanation;
  ASSERT_GE(answer.causes.size(), 2U);
  bool has_truth = false;
  for (const Cause& cause : answer.causes) {
    EXPECT_EQ(effects_of(answer).front(), "cyclic-error");
    ASSERT_TRUE(cause.period.has_value()) << cause.description;
    has_truth = has_truth || std::abs(*cause.period - 10) < 0.05;
    // The same readings: evidence differs by less than the limit of the set.
    EXPECT_NEAR(cause.evidence, answer.causes.front().evidence, 3.01) << cause.description;
  }
  EXPECT_TRUE(has_truth) << answer.explanation;
}

TEST(Causes, AreBothWhereTwoQuantitiesHaveOneShape) {
  // The temperature rises in proportion to the time: nothing separates the two.
  const auto seconds = [](int run, int row) { return 30.0 * (82 * run + row); };
  const auto cells = [&](int run, int row) {
    return fmt::format(",{:.1f},{:.4f}", seconds(run, row), 20 + seconds(run, row) / 2000);
  };
  const Diagnosis answer = diagnosed(runs_of(
      4, [&](double x, int, int run, int row) { return 1e-5 * x * seconds(run, row) / 2000; },
      ",t[s],T_x[degC]", cells));
  ASSERT_TRUE(answer.verdict == Verdict::kAmbiguous || answer.verdict == Verdict::kMissingEffect)
      << answer.explanation;
  EXPECT_TRUE(has(effects_of(answer), "thermal-scale")) << answer.explanation;
  EXPECT_EQ(answer.verdict == Verdict::kAmbiguous, answer.causes.size() > 1);
  EXPECT_TRUE(std::is_sorted(answer.causes.begin(), answer.causes.end(),
                             [](const Cause& a, const Cause& b) { return a.evidence > b.evidence; }));
}

TEST(Causes, OfShiftsInSeveralRunsHaveTheSetUpUnlessItStayed) {
  const std::vector<double> shifts = {0, 0.021, 0.034, 0, 0.021, 0};
  const auto error = [&](double, int, int run, int) { return shifts[static_cast<std::size_t>(run)]; };
  const Diagnosis open = diagnosed(runs_of(6, error));
  const Diagnosis stayed = diagnosed(runs_of(6, error, ",setup", [](int, int) { return ",one"; }));

  EXPECT_NE(open.verdict, Verdict::kMissingEffect) << open.explanation;
  const std::vector<std::string> names = effects_of(open);
  EXPECT_TRUE(has(names, "instrument set-up") || has(names, "instrument step") ||
              has(names, "instrument drift"))
      << open.explanation;
  EXPECT_FALSE(has(effects_of(stayed), "instrument set-up")) << stayed.explanation;
}

TEST(Causes, OfTheInstrumentHaveTheirKind) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> step(0, 0.0008);
  double drift = 0;
  const Diagnosis answer =
      diagnosed(runs_of(4, [&](double, int, int, int) { return drift += step(random); }));
  ASSERT_EQ(answer.verdict, Verdict::kInstrument) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(effects_of(answer), std::vector<std::string>{"instrument drift"});
}

// The temperature of a hall and an instrument that warms with the hall have the same period.
TEST(Causes, OfAShiftWithTheHallHaveTheInstrumentThatDriftsWithTheDay) {
  constexpr double kDay = 86400, kBetweenRows = 800;
  const auto turn = [&](int run, int row) {
    return 2 * std::numbers::pi * kBetweenRows * (82 * run + row) / kDay;
  };
  // The second hall has doors too: its temperature jumps as well, and an instrument of the day does not.
  for (const bool doors : {false, true}) {
    const auto warmth = [&](int run, int row) {
      return 1.5 * std::sin(turn(run, row)) + (doors && row % 20 < 7 ? 1.2 : 0.0);
    };
    const Diagnosis answer = diagnosed(runs_of(
        4, [&](double, int, int run, int row) { return 0.004 * warmth(run, row); }, ",t[s],T_x[degC]",
        [&](int run, int row) {
          return fmt::format(",{:.1f},{:.4f}", kBetweenRows * (82 * run + row), 20 + warmth(run, row));
        }));
    EXPECT_EQ(has(effects_of(answer), "instrument drift"), !doors) << answer.explanation;
    EXPECT_TRUE(has(effects_of(answer), "thermal-offset")) << answer.explanation;
    EXPECT_EQ(answer.verdict, doors ? Verdict::kMissingEffect : Verdict::kAmbiguous) << answer.explanation;
  }
}

// Six runs in one day: the walk of the instrument goes on from run to run.
TEST(Causes, OfAWalkThroughAllRunsAreTheInstrument) {
  for (const unsigned seed : {31U, 32U, 33U}) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> step(0, 0.0004);
    double walk = 0;
    std::string text = runs_of(
        6, [&](double, int, int, int) { return walk += step(random); }, ",t[s],T_x[degC]",
        [](int run, int row) {
          const double t = 60.0 * (82 * run + row);
          return fmt::format(",{:.1f},{:.4f}", t, 20 + 0.1 * std::sin(t / 3000));
        });
    EXPECT_EQ(effects_of(diagnosed(text)), std::vector<std::string>{"instrument drift"}) << "seed " << seed;
  }
}

// Humidity of the air changes what a laser reads, in proportion to the length. Nobody recorded it, and the
// temperature changed with it: a growth of 300 um/(m K) shrinking with warmth is of no material.
TEST(Causes, HaveNoGrowthThatNoMaterialHas) {
  for (const double growth : {11.5e-6, -300e-6}) {
    const auto warmth = [](int run, int row) { return 0.7 * std::sin(0.011 * (82 * run + row)); };
    const Diagnosis answer = diagnosed(runs_of(
        4, [&](double x, int, int run, int row) { return growth * x * warmth(run, row); }, ",T_x[degC]",
        [&](int run, int row) { return fmt::format(",{:.4f}", 20 + warmth(run, row)); }));
    EXPECT_EQ(has(effects_of(answer), "thermal-scale"), growth > 0) << answer.explanation;
  }
}

/// The temperature of a slide, and that of its cover, which follows the slide.
double slide_degC(int run, int row) { return 20 + 0.25 * std::sin(0.011 * (82 * run + row)); }
double cover_degC(int run, int row) { return slide_degC(run, row) + 0.05 * std::sin(0.3 * row + run); }

/// A search with a growth that is clearly accepted, and its alternatives: two thermometers show nearly the
/// same.
class Decision : public testing::Test {
 protected:
  Decision()
      : survey_(runs_of(
            4, [](double x, int, int run, int row) { return 11.5e-6 * x * (slide_degC(run, row) - 20); },
            ",T_slide[degC],T_cover[degC]",
            [](int run, int row) {
              return fmt::format(",{:.4f},{:.4f}", slide_degC(run, row), cover_degC(run, row));
            })),
        fitted_(fit::fit(survey_.machine, survey_.rows)),
        finder_(fitted_.machine, survey_.rows, effects_, 5, [](double, const std::string&) {}) {
    finder_.find();
  }

  Survey survey_;
  std::vector<effects::Effect> effects_ = effects::built_in_effects();
  fit::FitResult fitted_;
  Finder finder_;
};

TEST_F(Decision, TakesTheDistancesOfTheFits) {
  ASSERT_EQ(finder_.chosen().size(), 1U);
  const Alternatives linear = finder_.alternatives_to(finder_.chosen().front());
  ASSERT_FALSE(linear.other.empty());
  const double limit = finder_.evidence().thresholds().acceptance.distance_of_fits;
  const auto near =
      static_cast<std::size_t>(std::count_if(linear.other.begin(), linear.other.end(),
                                             [&](const Alternative& one) { return one.distance < limit; }));
  fit::FitResult accepted;
  accepted.chi_square = 320;
  accepted.converged = true;
  std::size_t fits = 0;
  const auto alternatives = [&](double chi_square, bool converged) {
    return alternatives_by_fits(finder_, finder_.chosen(), 0, 8,
                                {fitted_, accepted, [&](const std::vector<std::size_t>&) {
                                   ++fits;
                                   fit::FitResult other;
                                   other.chi_square = chi_square;
                                   other.converged = converged;
                                   return other;
                                 }});
  };

  const Alternatives same = alternatives(160, false), better = alternatives(160, true);

  ASSERT_EQ(same.other.size(), linear.other.size());
  EXPECT_EQ(same.other.front().distance, linear.other.front().distance);  // no fit converged
  EXPECT_EQ(fits, 2 * std::min<std::size_t>(8, near));
  ASSERT_GT(near, 0U);
  EXPECT_LT(better.other.front().distance, 0);
}

// The reversal is clear; what grows beside it follows one thermometer as well as the other.
TEST(Causes, OfALaterStepMakeItUncertain) {
  const Diagnosis answer = diagnosed(runs_of(
      4,
      [](double x, int sense, int run, int row) {
        return 0.015 * sense + 11.5e-6 * x * (slide_degC(run, row) - 20);
      },
      ",T_slide[degC],T_cover[degC]",
      [](int run, int row) {
        return fmt::format(",{:.4f},{:.4f}", slide_degC(run, row), cover_degC(run, row));
      }));
  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_EQ(answer.ladder.size(), 3U);
  EXPECT_EQ(answer.ladder[1].effect, "backlash");
  EXPECT_TRUE(answer.ladder[1].certain);
  EXPECT_TRUE(answer.ladder[1].causes.empty());
  EXPECT_EQ(answer.ladder[2].effect, "thermal-scale");
  EXPECT_FALSE(answer.ladder[2].certain);
  ASSERT_GE(answer.ladder[2].causes.size(), 2U);
  for (const Cause& cause : answer.ladder[2].causes)
    EXPECT_NE(answer.explanation.find(cause.description), std::string::npos) << answer.explanation;
}

// A spike behind each reversal that decays over the whole travel is the backlash itself, in a form with one
// more unknown.
TEST(Causes, HaveNoFormThatTheFitBringsToTheAcceptedOne) {
  const Diagnosis answer = diagnosed(runs_of(4, [](double, int sense, int, int) { return 0.0005 * sense; }));
  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(effects_of(answer), std::vector<std::string>{"backlash"});
}

/// A ball bar of 150 mm on circles at two feeds, both senses; `lag_s` of X and Y: how late each axis is.
Diagnosis circles_with_lag(double lag_x_s, double lag_y_s) {
  static const char* const table = R"xml(<machine name="m"><variables>
    <static><sX value="0"/><sY value="0"/></static>
    <machineaxes><X min="-200" max="200"/><Y min="-200" max="200"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" Y="Y*(1+sY)"/><sixdof n="2" X="X*(1+sX)"/></transforms></machine>)xml";
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],Y[mm],dirX,dirY,vX[mm/s],vY[mm/s],length[mm],cx[mm],cy[mm],cz[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run) {
    const double feed = run < 2 ? 20 : 50, sense = run % 2 == 0 ? 1 : -1;
    for (int row = 0; row < 90; ++row) {
      const double angle = sense * 2 * std::numbers::pi * (row + 0.5) / 90;
      const double x = 150 * std::cos(angle), y = 150 * std::sin(angle);
      const double vx = -feed * sense * std::sin(angle), vy = feed * sense * std::cos(angle);
      const double length = std::hypot(x - lag_x_s * vx, y - lag_y_s * vy) + noise(random);
      text += fmt::format("{},{},{},{},{},{},{:.6f},0,0,0,1,r{}\n", x, y, vx > 0 ? 1 : -1, vy > 0 ? 1 : -1,
                          vx, vy, length, run);
    }
  }
  static const DiagnoseOptions options;
  const Machine machine = parse_machine(table, "m.xml");
  return diagnose::diagnose(table, machine, parse_measurement(text, "m.csv", machine), options);
}

// A lag of X and a lead of Y have one column on a circle: one cause, which states both.
TEST(Causes, StateTheOtherAxisThatGivesTheSameReadingsOnACircle) {
  for (const bool x_is_late : {true, false}) {
    const Diagnosis answer = x_is_late ? circles_with_lag(1.3e-3, 1e-3) : circles_with_lag(1e-3, 1.3e-3);
    ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
    ASSERT_EQ(effects_of(answer), std::vector<std::string>{"servo-lag"});
    for (const char* const axis : {"X carriage: lag", "Y carriage: lag"}) {
      EXPECT_NE(answer.causes.front().description.find(axis), std::string::npos);
      EXPECT_NE(answer.explanation.find(axis), std::string::npos) << answer.explanation;
    }
    EXPECT_NE(answer.explanation.find("Only the difference of the axes is measured here"), std::string::npos);
  }
}

TEST_F(Decision, ReplacesACauseOnlyByOneThatPassesTheTests) {
  ASSERT_EQ(finder_.chosen().size(), 1U);
  const std::size_t cause = finder_.chosen().front();
  std::size_t replaced = 0;
  for (const Alternative& one : finder_.alternatives_to(cause).other) {
    if (!finder_.replace(cause, one.item)) {
      EXPECT_EQ(finder_.chosen(), std::vector<std::size_t>{cause});
      continue;
    }
    ++replaced;
    EXPECT_EQ(finder_.chosen(), std::vector<std::size_t>{one.item});
    ASSERT_TRUE(finder_.replace(one.item, cause));
  }
  EXPECT_LT(replaced, finder_.alternatives_to(cause).other.size());
}

}  // namespace
}  // namespace vernier::causes_test
