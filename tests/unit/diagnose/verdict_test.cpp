// What the answer says, not only which one it is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/diagnose/diagnosis.h"

namespace vernier {
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

  const Diagnosis answer = diagnose(kAxis, machine, rows);

  ASSERT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_GE(answer.ladder.size(), 2U);
  ASSERT_FALSE(answer.left.findings.empty());
  EXPECT_NE(answer.explanation.find(answer.left.findings.front().sentence), std::string::npos)
      << answer.explanation;
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

  const Diagnosis answer = diagnose(kAxis, machine, rows);

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

  const Diagnosis answer = diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));

  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  ASSERT_EQ(answer.ladder.size(), 3U);
  EXPECT_EQ(answer.ladder[1].effect, "cyclic-error");
  EXPECT_EQ(answer.ladder[2].effect, "cyclic-error");
}

}  // namespace
}  // namespace vernier
