// SPDX-License-Identifier: GPL-3.0-or-later
// A robot that holds a target at an uncertain place: readings of one target show this place only together
// with the zero and the length of the last joint.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::tool_point_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 281140;

/// Two joints that carry a third one across. x, y: place of the target on the flange, mm; zero: of the last
/// joint, deg.
std::string arm(double x, double y, double zero) {
  return fmt::format(
      R"(<machine name="arm"><variables><static><th2 value="0" nominal="0" unit="deg"/><a2 value="300" nominal="300" unit="mm"/>
  <th3 value="{}" nominal="0" unit="deg"/><d3 value="80" nominal="80" unit="mm"/><BaseShift X="0"/></static>
  <machineaxes><A rotary="true" min="-180" max="180"/><B rotary="true" min="-120" max="120"/>
  <C rotary="true" min="-180" max="180"/></machineaxes></variables><transforms branch="tool">
  <DH n="1" theta="A" d="200" a="0" alpha="90"/><DH n="2" theta="B+th2" d="0" a="a2" alpha="90"/>
  <DH n="3" theta="C+th3" d="d3" a="0" alpha="0"/><sixdof n="4" X="{}" Y="{}" Z="40"/></transforms></machine>)",
      zero, x, y);
}

std::string readings_of(const std::string& robot) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> turn(-100, 100);
  std::normal_distribution<double> noise(0, 0.01);
  std::string rows = "A[deg],B[deg],C[deg],x[mm],y[mm],z[mm],u[um],role\n";
  for (int i = 0; i < 90; ++i)
    rows += fmt::format("{:.3f},{:.3f},{:.3f},0,0,0,10,{}\n", turn(random), turn(random), turn(random),
                        i % 5 == 4 ? "check" : "fit");
  const Machine machine = parse_machine(robot, "robot.xml");
  const Measurement poses = parse_measurement(rows, "poses.csv", machine);
  const Eigen::VectorXd at = predict(machine, poses);
  std::string text = "A[deg],B[deg],C[deg],x[mm],y[mm],z[mm],u[um],role\n";
  for (std::size_t i = 0; i < poses.rows(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto& axis = poses.states.axis;
    text += fmt::format("{},{},{},{:.6f},{:.6f},{:.6f},10,{}\n", axis[0][row], axis[1][row], axis[2][row],
                        at[3 * row] + noise(random), at[3 * row + 1] + noise(random),
                        at[3 * row + 2] + noise(random), poses.check[i] != 0 ? "check" : "fit");
  }
  return text;
}

/// The diagnosis of an arm with the target at (30, -12), by the readings of another one.
Diagnosis diagnosed_by(const std::string& real) {
  const std::string given = arm(30, -12, 0);
  const Machine machine = parse_machine(given, "m.xml");
  return diagnose::diagnose(given, machine, parse_measurement(readings_of(real), "m.csv", machine));
}

double value_of(const Machine& machine, const std::string& name) {
  const auto found = machine.find_static(name);
  return found ? machine.statics[*found].value : std::nan("");
}

// Named before: one length of the point, and 2.4 deg of the last joint took the rest.
TEST(ToolPoint, IsNamedAsAWholeAndTheLastJointKeepsItsZero) {
  const Diagnosis answer = diagnosed_by(arm(30.6, -12.7, 0));

  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.at(1).add, "offset:branch=tool,transform=4,form=point");
  EXPECT_NEAR(value_of(answer.end.machine, "offset_X4"), 0.6, 0.1);
  EXPECT_NEAR(value_of(answer.end.machine, "offset_Y4"), -0.7, 0.1);
  EXPECT_LT(std::abs(value_of(answer.end.machine, "th3")), 0.1);
}

/// A wrong zero alone explains the readings, and the tool is not asked.
TEST(ToolPoint, IsNotBlamedForTheZeroOfTheLastJoint) {
  const Diagnosis answer = diagnosed_by(arm(30, -12, 0.4));

  EXPECT_EQ(answer.verdict, Verdict::kConsistent) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_NEAR(value_of(answer.end.machine, "th3"), 0.4, 0.05);
}

}  // namespace
}  // namespace vernier::tool_point_test
