// SPDX-License-Identifier: GPL-3.0-or-later
// Causes of errors that touches show: the bed of a printer, the sockets of a robot. No instrument measured.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/touched_positions.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::touch_diagnose_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 31;

const char* const kPrinter = R"(<machine name="printer"><variables>
  <machineaxes><X min="0" max="220"/><Y min="0" max="220"/><Z min="0" max="250"/></machineaxes>
  <artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" Y="Y" Z="Z"/><sixdof n="2" X="X"/></transforms></machine>)";

/// Touches of a sloping bed at 25 points, four times; u: standard uncertainty, mm. error: added to the height
/// at which the nozzle touches.
std::string bed(double u_mm, const std::function<double(double x, double y)>& error_mm) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, u_mm);
  std::string text = "X[mm],Y[mm],Z[mm],on,run,role,u[mm]\n";
  for (int run = 0; run < 4; ++run)
    for (int y = 10; y <= 210; y += 50)
      for (int x = 10; x <= 210; x += 50)
        text += fmt::format("{},{},{:.5f},bed,r{},{},{}\n", x, y,
                            0.3 - 0.0015 * x + 0.0008 * y + error_mm(x, y) + noise(random), run,
                            run == 3 ? "check" : "fit", u_mm);
  return text;
}

Diagnosis diagnosed(const std::string& machine, const std::string& rows) {
  static const DiagnoseOptions options;  // answers point into its effects
  const Machine given = parse_machine(machine, "m.xml");
  return diagnose::diagnose(machine, given, parse_measurement(rows, "m.csv", given), options);
}

TEST(TouchDiagnosis, ABedThatSlopesIsNoErrorOfThePrinter) {
  for (const double u_mm : {0.01, 0.001}) {
    const Diagnosis answer = diagnosed(kPrinter, bed(u_mm, [](double, double) { return 0; }));
    EXPECT_EQ(answer.verdict, Verdict::kConsistent) << answer.explanation;
  }
}

TEST(TouchDiagnosis, TheSagOfABeamIsNamed) {
  for (const double u_mm : {0.01, 0.001}) {
    const Diagnosis answer = diagnosed(
        kPrinter, bed(u_mm, [](double x, double) { return 0.1 * (1 - std::pow((x - 110) / 110, 2)); }));
    EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << answer.explanation;
    ASSERT_GE(answer.ladder.size(), 2U);
    EXPECT_EQ(answer.ladder[1].said, "X carriage: straightness along Z");
    ASSERT_TRUE(answer.ladder.back().check_rms_um);
    EXPECT_LT(*answer.ladder.back().check_rms_um, 1200 * u_mm);
  }
}

TEST(TouchDiagnosis, SocketsOfARobotWithoutAHiddenEffectAreConsistent) {
  const std::string folder = VERNIER_SOURCE_DIR;
  const Diagnosis answer = diagnosed(text::read_file(folder + "/tables/machines/ur10e.xml"),
                                     text::read_file(folder + "/tests/data/touch/sockets.csv"));
  EXPECT_EQ(answer.verdict, Verdict::kConsistent) << answer.explanation;
}

const char* const kMill = R"(<machine name="mill"><variables><static>
  <sq value="0" nominal="0" unit="deg"/></static>
  <machineaxes><X min="0" max="400"/><Y min="0" max="300"/><Z min="-300" max="0"/></machineaxes>
  <artefact name="ball" type="sphere" radius="15mm"/><artefact name="wall" type="plane"/>
  <artefact name="floor" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" X="X"/><sixdof n="2" Y="Y" rZ="sq"/><sixdof n="3" Z="Z"/></transforms></machine>)";

/// Touches of a ball from above and of two planes, from a machine without an error. The axes stop where the
/// probe touches: the error of a touch, u, is in the recorded positions.
std::string touches(std::uint64_t seed, double u_mm, bool ball, bool planes) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, u_mm);
  std::uniform_real_distribution<double> share(0, 1);
  std::string text = "X[mm],Y[mm],Z[mm],on,run,u[mm]\n";
  for (int i = 0; i < 120; ++i) {
    const Eigen::Vector3d free(40 + 300 * share(random), 40 + 200 * share(random),
                               -250 + 200 * share(random));
    const auto row = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const char* on) {
      const Eigen::Vector3d p = point + noise(random) * normal;
      text += fmt::format("{:.6f},{:.6f},{:.6f},{},r{},{}\n", p.x(), p.y(), p.z(), on, i / 40, u_mm);
    };
    if (ball) {
      const double height = share(random), turn = 6.283 * share(random),
                   across = std::sqrt(1 - height * height);
      const Eigen::Vector3d normal(across * std::cos(turn), across * std::sin(turn), height);
      row(Eigen::Vector3d(200, 150, -100) + 15 * normal, normal, "ball");
    }
    if (planes) {
      row({380, free.y(), free.z()}, {1, 0, 0}, "wall");
      row({free.x(), free.y(), -280}, {0, 0, 1}, "floor");
    }
  }
  return text;
}

TEST(TouchDiagnosis, PositionsThatContainTheErrorOfTheTouchExplainNothing) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const auto& [ball, planes] : {std::pair(true, false), {false, true}, {true, true}}) {
      const Diagnosis answer = diagnosed(kMill, touches(seed, 0.002, ball, planes));
      EXPECT_EQ(answer.verdict, Verdict::kConsistent) << "seed " << seed << (ball ? ", ball" : "")
                                                      << (planes ? ", planes: " : ": ") << answer.explanation;
    }
  }
}

TEST(TouchDiagnosis, OneWrongTouchAmongManyIsNamed) {
  std::string text = touches(3, 0.002, true, true);
  const std::size_t row = text.find(",floor", text.size() / 2), at = text.rfind(',', row - 1) + 1;
  text.replace(at, row - at, fmt::format("{:.6f}", std::stod(text.substr(at, row - at)) + 0.04));
  const Diagnosis answer = diagnosed(kMill, text);
  EXPECT_EQ(answer.verdict, Verdict::kInstrument) << answer.explanation;
  EXPECT_EQ(answer.instrument, "outliers");
}

TEST(TouchedPositions, AreOnTheTouchedObject) {
  const Machine mill = parse_machine(kMill, "m.xml");
  const Measurement m = parse_measurement(touches(1, 0.01, true, true), "m.csv", mill);
  const std::vector<Column> at = touched_positions(mill, m);
  Measurement moved = m;
  moved.states.axis = at;
  EXPECT_LT(predict(mill, moved).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(predict(mill, m).cwiseAbs().maxCoeff(), 0.01);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_LT((at[axis] - m.states.axis[axis]).abs().maxCoeff(), 0.06);
  EXPECT_NEAR(at[1][1], m.states.axis[1][1], 1e-5) << "along a wall in Y and Z nothing moves";
}

}  // namespace
}  // namespace vernier::touch_diagnose_test
