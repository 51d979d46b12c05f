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

}  // namespace
}  // namespace vernier
