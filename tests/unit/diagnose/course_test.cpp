// SPDX-License-Identifier: GPL-3.0-or-later
// A name states on what an error depends. These errors depend on another quantity, which no column records.
#include "tools/diagnose/doubts/course.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine_reader.h"

namespace vernier::course_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 281130;

const char* const kTable = R"(<machine name="m"><variables><static><BaseShift X="0" Y="0"/></static>
  <machineaxes><X rotary="false" min="0" max="500"/><Y rotary="false" min="0" max="400"/></machineaxes>
  </variables><transforms branch="tool"><sixdof n="1" Y="Y"/><sixdof n="2" X="X"/></transforms></machine>)";

/// Poses in a random order, in four runs. The moves have lengths between nothing and the whole travel.
struct Poses {
  Eigen::ArrayXd x = Eigen::ArrayXd::Zero(kRows), y = x, time = x;
  static constexpr int kRows = 240, kOfRun = 60;

  Poses() {
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> part(0, 1);
    for (int i = 0; i < kRows; ++i) {
      x[i] = std::round(500 * part(random));
      y[i] = std::round(400 * part(random));
      time[i] = i == 0 ? 0 : time[i - 1] + 20 + (i % kOfRun == 0 ? 1800 : 0);
    }
  }
  double move_x(int i) const { return i % kOfRun == 0 ? 0 : x[i] - x[i - 1]; }
  double move_y(int i) const { return i % kOfRun == 0 ? 0 : y[i] - y[i - 1]; }
  /// +1 or -1: the sense of the last move, of this row or an earlier one.
  int sense(const Eigen::ArrayXd& at, int i) const {
    for (; i > 0; --i)
      if (at[i] != at[i - 1]) return at[i] > at[i - 1] ? 1 : -1;
    return 1;
  }
};

/// The diagnosis of errors (mm) in X with u = 1 um. `logged`: a temperature of each row.
Diagnosis diagnosis_of(const Poses& poses, const Eigen::ArrayXd& error, const Eigen::ArrayXd& logged) {
  std::mt19937_64 random(kSeed + 1);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "t[s],X[mm],Y[mm],dirX,dirY,T_bed[degC],x[mm],y[mm],u[um],run,role\n";
  for (int i = 0; i < Poses::kRows; ++i) {
    const double x = poses.x[i] + error[i] + noise(random), y = poses.y[i] + noise(random);
    text += fmt::format("{},{},{},{},{},{:.4f},{:.6f},{:.6f},1,r{},{}\n", poses.time[i], poses.x[i],
                        poses.y[i], poses.sense(poses.x, i), poses.sense(poses.y, i), logged[i], x, y,
                        i / Poses::kOfRun, i % 5 == 4 ? "check" : "fit");
  }
  const Machine machine = parse_machine(kTable, "m.xml");
  return diagnose::diagnose(kTable, machine, parse_measurement(text, "m.csv", machine));
}

/// The diagnosis of an error (mm) in Y of rows at 0, `middle` or 20 mm/s of X, with u = 1 um.
Diagnosis diagnosis_at_speeds(const Poses& poses, double middle, double (*error_at)(double speed)) {
  std::mt19937_64 random(kSeed + 2);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],Y[mm],vX[mm/s],x[mm],y[mm],u[um],run,role\n";
  for (int i = 0; i < Poses::kRows; ++i) {
    const std::array speeds{0.0, middle, 20.0};
    const double speed = speeds[random() % speeds.size()];
    const double x = poses.x[i] + noise(random), y = poses.y[i] + error_at(speed) + noise(random);
    text += fmt::format("{},{},{},{:.6f},{:.6f},1,r{},{}\n", poses.x[i], poses.y[i], speed, x, y,
                        i / Poses::kOfRun, i % 5 == 4 ? "check" : "fit");
  }
  const Machine machine = parse_machine(kTable, "m.xml");
  return diagnose::diagnose(kTable, machine, parse_measurement(text, "m.csv", machine));
}

bool names_nothing(const Diagnosis& answer) {
  return answer.verdict == Verdict::kUnexplained &&
         std::none_of(answer.ladder.begin() + 1, answer.ladder.end(),
                      [](const LadderStep& step) { return step.certain; });
}

/// A temperature of the hall that has nothing to do with the error.
Eigen::ArrayXd hall(const Poses& poses) { return 20 + 0.5 * (poses.time / 2100).sin(); }

/// The scale follows the humidity of the hall, which rises on the whole as a warm-up does.
TEST(Course, AnErrorThatOnlyRisesLikeAWarmUpIsNoWarmUp) {
  const Poses poses;
  const Eigen::ArrayXd rise = 1 - (-poses.time / 3000).exp(), part = poses.x / 500;
  const Eigen::ArrayXd humidity = rise + 0.4 * (poses.time / 500).sin();

  const Diagnosis unrecorded = diagnosis_of(poses, 0.008 * part * humidity, hall(poses));
  const Diagnosis warm_up = diagnosis_of(poses, 0.008 * part * rise, hall(poses));

  EXPECT_TRUE(names_nothing(unrecorded)) << "seed " << kSeed << ": " << unrecorded.explanation;
  EXPECT_NE(unrecorded.explanation.find("another course over the rows"), std::string::npos)
      << unrecorded.explanation;
  EXPECT_EQ(warm_up.verdict, Verdict::kMissingEffect) << warm_up.explanation;
  EXPECT_EQ(warm_up.ladder.at(1).effect, "warmup-drift");
}

/// The scale follows a temperature of which the thermometer sees a part, beside another warmth.
TEST(Course, AThermometerThatFollowsTheErrorInPartIsNotItsCause) {
  const Poses poses;
  const Eigen::ArrayXd own = (poses.time / 1100).sin() + 0.6 * (poses.time / 530).cos();
  const Eigen::ArrayXd other = (poses.time / 760 + 1).sin();
  const Eigen::ArrayXd error = 1.5e-5 * poses.x * own;

  const Diagnosis decoy = diagnosis_of(poses, error, 20 + 0.8 * own + 0.6 * other);
  const Diagnosis cause = diagnosis_of(poses, error, 20 + own);

  EXPECT_TRUE(names_nothing(decoy)) << "seed " << kSeed << ": " << decoy.explanation;
  EXPECT_EQ(cause.verdict, Verdict::kMissingEffect) << cause.explanation;
  EXPECT_EQ(cause.ladder.at(1).effect, "thermal-scale");
}

/// A load that no column records bends the beam: on average a curve of the axis, but not at any time.
TEST(Course, ACurveThatChangesWithAnUnknownLoadIsNoStraightness) {
  const Poses poses;
  const Eigen::ArrayXd part = poses.x / 500, sag = 0.012 * part * (1 - part);
  Eigen::ArrayXd load(Poses::kRows);
  for (int i = 0; i < Poses::kRows; ++i) load[i] = i / 40 % 3 * 0.9;

  const Diagnosis loaded = diagnosis_of(poses, sag * load, hall(poses));
  const Diagnosis steady = diagnosis_of(poses, sag, hall(poses));

  EXPECT_TRUE(names_nothing(loaded)) << "seed " << kSeed << ": " << loaded.explanation;
  EXPECT_EQ(steady.verdict, Verdict::kMissingEffect) << steady.explanation;
  EXPECT_EQ(steady.ladder.at(1).effect, "positioning-error");
}

/// A drag along the previous move grows with its share in Y: the sense alone explains most of it.
TEST(Course, ADragAlongThePreviousMoveIsNoPlay) {
  const Poses poses;
  Eigen::ArrayXd drag = Eigen::ArrayXd::Zero(Poses::kRows), play = drag;
  for (int i = 0; i < Poses::kRows; ++i) {
    const double length = std::hypot(poses.move_x(i), poses.move_y(i));
    drag[i] = length > 0 ? 0.0025 * poses.move_y(i) / length : 0;
    play[i] = 0.002 * poses.sense(poses.y, i);
  }

  const Diagnosis dragged = diagnosis_of(poses, drag, hall(poses));
  const Diagnosis loose = diagnosis_of(poses, play, hall(poses));

  EXPECT_TRUE(names_nothing(dragged)) << "seed " << kSeed << ": " << dragged.explanation;
  EXPECT_NE(dragged.explanation.find("depends on the previous move"), std::string::npos)
      << dragged.explanation;
  EXPECT_EQ(loose.verdict, Verdict::kMissingEffect) << loose.explanation;
  EXPECT_EQ(loose.ladder.at(1).effect, "lateral-play");
}

/// Wind-up: after a reversal the error is still that of the other direction. A play operator (Prandtl) moves
/// nearly in the same way.
TEST(Course, AReversalErrorThatBuildsUpIsNoBacklash) {
  const Poses poses;
  constexpr double kTravel = 60, kHalfWidth = 60;  // mm: an eighth of the axis
  Eigen::ArrayXd wind_up(Poses::kRows), play(Poses::kRows), jump(Poses::kRows);
  double since = 1e9, free = 0;
  for (int i = 0; i < Poses::kRows; ++i) {
    const int sense = poses.sense(poses.x, i);
    const double step = i > 0 ? std::abs(poses.x[i] - poses.x[i - 1]) : 0;
    since = i > 0 && sense != poses.sense(poses.x, i - 1) ? step : since + step;
    wind_up[i] = 0.003 * sense * (1 - 2 * std::exp(-since / kTravel));
    free = std::clamp(free, poses.x[i] - kHalfWidth, poses.x[i] + kHalfWidth);
    play[i] = 0.0025 * (free - poses.x[i]) / kHalfWidth;
    jump[i] = 0.003 * sense;
  }

  const Diagnosis wound = diagnosis_of(poses, wind_up, hall(poses));
  const Diagnosis played = diagnosis_of(poses, play, hall(poses));
  const Diagnosis jumped = diagnosis_of(poses, jump, hall(poses));

  EXPECT_EQ(wound.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << wound.explanation;
  EXPECT_EQ(wound.ladder.at(1).effect, "hysteresis");
  for (std::size_t i = 2; i < wound.ladder.size(); ++i)
    EXPECT_FALSE(wound.ladder[i].certain) << wound.ladder[i].effect;
  EXPECT_NE(wound.explanation.find("90 % after a travel of 1"), std::string::npos) << wound.explanation;
  EXPECT_EQ(played.ladder.at(1).effect, "hysteresis") << played.explanation;
  for (const LadderStep& step : played.ladder) EXPECT_NE(step.effect, "backlash");
  EXPECT_EQ(jumped.verdict, Verdict::kMissingEffect) << jumped.explanation;
  ASSERT_EQ(jumped.ladder.size(), 2u);
  EXPECT_EQ(jumped.ladder[1].effect, "backlash");
}

/// A linear test: targets in both directions, with an overrun at the ends that the file does not contain. The
/// travel since a reversal is a function of position and direction there. A table of the backlash and a curve
/// of the axis would explain the same readings.
TEST(Course, AReversalErrorBetweenTheSameEndsIsOneCause) {
  constexpr double kOverrun = 4, kWidth = 120, kHalf = 0.004;  // mm
  std::mt19937_64 random(kSeed + 3);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],Y[mm],dirX,x[mm],u[um],run,role\n";
  for (int run = 0; run < 5; ++run)
    for (const int dir : {1, -1})
      for (int i = 0; i < 11; ++i) {
        const double x = 20 + 46 * (dir > 0 ? i : 10 - i) + (i % 3);
        const double since = (dir > 0 ? x - 20 : 482 - x) + kOverrun;
        const double error = kHalf * dir * std::min(1.0, 2 * since / kWidth - 1) + 2e-5 * x;
        text += fmt::format("{},200,{},{:.6f},1,r{},{}\n", x, dir, x + error + noise(random), run,
                            (run * 11 + i) % 5 == 4 ? "check" : "fit");
      }
  const Machine machine = parse_machine(kTable, "m.xml");
  const Diagnosis answer = diagnose::diagnose(kTable, machine, parse_measurement(text, "m.csv", machine));

  std::set<std::string> certain;
  for (std::size_t i = 1; i < answer.ladder.size(); ++i)
    if (answer.ladder[i].certain) certain.insert(answer.ladder[i].effect);
  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(certain, (std::set<std::string>{"hysteresis", "scale-error"})) << answer.explanation;
}

/// With two clearly different speeds any shift of the fast rows is a square: these have a shift in the place
/// of it.
TEST(Course, AShiftOfTheRowsOfOneSpeedIsNoContourLoss) {
  const Poses poses;
  const auto shift = [](double speed) { return speed > 15 ? 0.006 : 0.0; };
  const auto square = [](double speed) { return 0.006 * speed * speed / 400; };

  const Diagnosis of_one_speed = diagnosis_at_speeds(poses, 5, shift);
  const Diagnosis of_three = diagnosis_at_speeds(poses, 10, square);

  EXPECT_TRUE(names_nothing(of_one_speed)) << "seed " << kSeed << ": " << of_one_speed.explanation;
  EXPECT_NE(of_one_speed.explanation.find("measure at three speeds"), std::string::npos)
      << of_one_speed.explanation;
  EXPECT_EQ(of_three.verdict, Verdict::kMissingEffect) << of_three.explanation;
  EXPECT_EQ(of_three.ladder.at(1).effect, "centrifugal");
}

/// Swings of Y about its middle, at one X, then swings of X: few poses beside the turning points. `error`: of
/// a row of Y, mm; from its position and the number of the swing.
Diagnosis diagnosis_of_swings(const std::function<double(double y, int swing)>& error) {
  constexpr int kSwings = 14, kOfSwing = 6;
  std::mt19937_64 random(kSeed + 3);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],Y[mm],dirX,dirY,x[mm],y[mm],u[um],run,role\n";
  double y = 40, x = 60;
  for (const bool of_y : {true, false})
    for (int swing = 0; swing < kSwings; ++swing) {
      const int sense = swing % 2 == 0 ? 1 : -1;
      const double far = of_y ? 80 + 9 * swing : 150 + 5 * swing;
      for (int k = 0; k < kOfSwing; ++k) {
        const double at = sense * far * (2.0 * k / (kOfSwing - 1) - 1);
        (of_y ? y : x) = std::round((of_y ? 200 : 250) + at);
        const double off = error(y, of_y ? swing : kSwings - 1);
        const double noise_y = noise(random), noise_x = noise(random);
        text += fmt::format("{},{},{},{},{:.6f},{:.6f},1,r{},{}\n", x, y, of_y ? 1 : sense, of_y ? sense : -1,
                            x + noise_x, y + off + noise_y, (of_y ? 0 : 5) + swing / 3,
                            k == swing % kOfSwing ? "check" : "fit");
      }
    }
  const Machine machine = parse_machine(kTable, "m.xml");
  return diagnose::diagnose(kTable, machine, parse_measurement(text, "m.csv", machine));
}

/// After each reversal the carriage rests at another place (stick-slip).
TEST(Course, AnOffsetThatChangesAtEachReversalIsNoFunctionOfThePosition) {
  constexpr std::uint64_t kSeedOfOffsets =
      4;  // of eight, the one whose offsets a cyclic error fits by chance
  std::mt19937_64 random(kSeedOfOffsets);
  std::vector<double> rest(14);
  for (double& one : rest) one = std::uniform_real_distribution<double>(-0.008, 0.008)(random);
  const Diagnosis answer =
      diagnosis_of_swings([&](double, int swing) { return rest[static_cast<std::size_t>(swing)]; });
  EXPECT_TRUE(names_nothing(answer)) << answer.explanation;
  const Diagnosis backlash =
      diagnosis_of_swings([](double, int swing) { return swing % 2 == 0 ? 0.002 : -0.002; });
  EXPECT_EQ(backlash.verdict, Verdict::kMissingEffect) << backlash.explanation;
  EXPECT_EQ(backlash.ladder.at(1).effect, "backlash");
  const Diagnosis scale = diagnosis_of_swings([](double y, int) { return 2e-5 * y; });
  EXPECT_NE(scale.verdict, Verdict::kUnexplained) << scale.explanation;
  EXPECT_EQ(scale.ladder.at(1).effect, "scale-error");
}

}  // namespace
}  // namespace vernier::course_test
