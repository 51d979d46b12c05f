// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/part_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/unit/offline/machine.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"

namespace vernier::offline_test {

using namespace vernier::model;
using namespace vernier::offline;
using namespace vernier::text;
namespace {

using Eigen::Vector3d;

constexpr double kDeviation_mm = 0.0005, kJump_mm = 0.01;

PartProgram corrected(const std::string& text, const std::vector<char>& known = {0, 0, 0},
                      bool arcs = false) {
  const Machine machine = bridge();
  Corrector corrector(machine);
  PartProgramOptions options;
  options.deviation_mm = kDeviation_mm;
  options.zero = {0, 0, 0};
  options.arcs = arcs;
  return corrected_program(text, "part.ngc", at_rest(machine), known, options, corrector);
}

std::string error_of(const std::string& text) {
  try {
    corrected(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Axis positions of the written moves, by a reader that knows nothing but absolute G0 and G1.
std::vector<Vector3d> points_of(const std::string& text) {
  std::vector<Vector3d> points;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" X") == std::string::npos) continue;
    const auto value = [&](char letter) {
      return std::stod(line.substr(line.find(std::string(" ") + letter) + 2));
    };
    points.emplace_back(value('X'), value('Y'), value('Z'));
  }
  return points;
}

/// Where an ideal machine would be, for axis positions of the real one between two points.
Vector3d ideal(const Vector3d& at, const Vector3d& from, const Vector3d& to) {
  const Machine machine = bridge();
  Corrector back(machine, {.with_rotary = false, .back = true});
  States states = at_rest(machine);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    states.axis[i][0] = at[k];
    states.direction[i][0] = to[k] > from[k] ? 1 : to[k] < from[k] ? -1 : 0;
  }
  return back.commands(states).col(0);
}

TEST(PartPrograms, LinesStayWithinTheDeviation) {
  const PartProgram program = corrected("G21 G90\nG0 X10 Y20 Z-50\nG1 X580 Y320 F3000\n");
  const std::vector<Vector3d> points = points_of(program.text);
  ASSERT_GT(points.size(), 20U);
  EXPECT_EQ(program.moves, 2U);
  EXPECT_EQ(program.written, points.size());
  const Vector3d from(10, 20, -50), way = Vector3d(580, 320, -50) - from;
  double worst = 0;
  for (std::size_t k = 2; k < points.size(); ++k)
    for (const double share : {0.3, 0.5, 1.0}) {
      if ((points[k] - points[k - 1]).norm() < kJump_mm) continue;
      const Vector3d at = points[k - 1] + share * (points[k] - points[k - 1]);
      const Vector3d off = ideal(at, points[k - 1], points[k]) - from;
      worst = std::max(worst, (off - way * (off.dot(way) / way.squaredNorm())).norm());
    }
  EXPECT_LT(worst, kDeviation_mm + 2e-5);  // the digits that are written
  EXPECT_GT((points.back() - Vector3d(580, 320, -50)).norm(), 0.01);
}

/// A ball screw of a small machine: looks a whole millimetre apart would never see its wave.
TEST(PartPrograms, AWaveShorterThanTheStepOfTheLooksIsCorrected) {
  const Machine machine = parse_machine(
      R"XML(<machine name="small"><variables><static><cyc value="0.004" nominal="0" unit="mm"/></static>
      <machineaxes><X min="0" max="100"/><Y min="0" max="100"/><Z min="0" max="100"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" X="X+cyc*sin(360*X/1)" Y="Y" Z="Z"/></transforms></machine>)XML",
      "small.xml");
  Corrector corrector(machine);
  PartProgramOptions options;
  options.deviation_mm = kDeviation_mm;
  options.zero = {0, 0, 0};
  const PartProgram program = corrected_program("G21 G90\nG0 X0 Y0 Z0\nG1 X20 Y10 F600\n", "small.ngc",
                                                at_rest(machine), {0, 0, 0}, options, corrector);
  const std::vector<Vector3d> points = points_of(program.text);
  ASSERT_GT(points.size(), 38U);  // two chords a period: the path is crossed at an angle
  double worst = 0;
  for (std::size_t k = 2; k < points.size(); ++k)
    for (const double share : {0.3, 0.5, 1.0}) {
      const Vector3d at = points[k - 1] + share * (points[k] - points[k - 1]);
      States states = at_rest(machine);
      for (Eigen::Index i = 0; i < 3; ++i) states.axis[static_cast<std::size_t>(i)][0] = at[i];
      const Vector3d tool = forward(machine, states).position.col(0);
      worst = std::max(worst, (tool - tool.dot(Vector3d(20, 10, 0)) / 500 * Vector3d(20, 10, 0)).norm());
    }
  EXPECT_LE(worst, kDeviation_mm + 2e-5);  // and the digits of the program
  EXPECT_LE(program.worst_mm, kDeviation_mm);
  EXPECT_GE(program.worst_mm, 0.2 * worst);
}

TEST(PartPrograms, ABumpNarrowerThanTheStepOfTheLooksIsCorrected) {
  const Machine machine = parse_machine(
      R"XML(<machine name="bump"><variables><static><k value="0.0135" nominal="0" unit="mm"/></static>
      <machineaxes><X min="0" max="250"/><Y min="0" max="250"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" X="X" Y="Y+k*exp(0-((X-51.283)/0.0822)^2)"/></transforms></machine>)XML",
      "bump.xml");
  Corrector corrector(machine);
  PartProgramOptions options;
  options.deviation_mm = kDeviation_mm;
  options.zero = {0, 0};
  const PartProgram program = corrected_program("G21 G90\nG0 X0 Y10\nG1 X120 Y10 F600\n", "bump.ngc",
                                                at_rest(machine), {0, 0}, options, corrector);
  // THEN a block ends near the top of the bump, corrected by it
  double lowest = 10;
  std::istringstream lines(program.text);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t y = line.find('Y'); y != std::string::npos && line.find('X') != std::string::npos)
      lowest = std::min(lowest, std::stod(line.substr(y + 1)));
  EXPECT_NEAR(lowest, 10 - 0.0135, kDeviation_mm);
}

TEST(PartPrograms, ArcsOfEveryPlaneStayOnTheirCircle) {
  struct Case {
    const char* block;
    Vector3d centre;
    int normal;
  };
  for (const Case& one : {Case{"G17 G3 X300 Y250 I0 J50 F1000", {300, 200, -50}, 2},
                          Case{"G18 G2 X350 Z-100 I50 K0 F1000", {350, 150, -50}, 1},
                          Case{"G19 G2 Y200 Z-100 J50 K0 F1000", {300, 200, -50}, 0},
                          Case{"G17 G2 X300 Y150 I0 J50 F1000", {300, 200, -50}, 2}}) {
    const PartProgram program = corrected(std::string("G21 G90\nG0 X300 Y150 Z-50\n") + one.block + "\n");
    const std::vector<Vector3d> points = points_of(program.text);
    ASSERT_GT(points.size(), 10U) << one.block;
    double worst = 0, length = 0;
    for (std::size_t k = 2; k < points.size(); ++k) {
      // Where an axis turns round the sense of so short a step is that of the correction.
      const Vector3d step = (points[k] - points[k - 1]).cwiseAbs();
      if (step.norm() < kJump_mm || (one.normal != 1 && step.y() < kJump_mm)) continue;
      length += (points[k] - points[k - 1]).norm();
      for (const double share : {0.5, 1.0}) {
        Vector3d out =
            ideal(points[k - 1] + share * (points[k] - points[k - 1]), points[k - 1], points[k]) - one.centre;
        out[one.normal] = 0;
        worst = std::max(worst, std::abs(out.norm() - 50));
      }
    }
    EXPECT_LT(worst, kDeviation_mm + 2e-5) << one.block;
    // The turn takes the way round that its code says: 180, 90, 90 and 360 degrees.
    EXPECT_GT(length, 70) << one.block;
  }
  // R: the lesser arc, and the greater one for a negative radius.
  const auto length_of = [](const char* radius) {
    const std::vector<Vector3d> points = points_of(
        corrected(std::string("G90\nG0 X300 Y150 Z-50\nG2 X350 Y200 R") + radius + " F1000\n").text);
    double length = 0;
    for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
    return length;
  };
  EXPECT_NEAR(length_of("50"), 50 * M_PI / 2, 0.2);
  EXPECT_NEAR(length_of("-50"), 150 * M_PI / 2, 0.4);
}

TEST(PartPrograms, KeepWhatIsNoMotionAndUnderstandSteps) {
  const PartProgram program =
      corrected("%\n(part)\nG20 G91\nM3 S1000\nG0 X1 Y1 Z-1 T1\nG90\nG93 G1 X2 F2 (slow)\n%\n", {1, 1, 1});
  EXPECT_NE(program.text.find("M3 S1000\n"), std::string::npos);
  EXPECT_NE(program.text.find("T1 G90 G0 X"), std::string::npos);
  EXPECT_NE(program.text.find("(slow)"), std::string::npos);
  EXPECT_EQ(program.text.find("G91"), std::string::npos);
  // The parts of a block share its time: minutes add up to 1/2.
  double minutes = 0;
  std::istringstream lines(program.text);
  for (std::string line; std::getline(lines, line);)
    if (line.find("G1 ") != std::string::npos) minutes += 1 / std::stod(line.substr(line.find(" F") + 2));
  EXPECT_NEAR(minutes, 0.5, 1e-4);
}

TEST(PartPrograms, RefuseWhatTheyCannotFollow) {
  EXPECT_NE(error_of("G90\nG0 X1 Y1 Z0\nG41 D1\n").find("part.ngc:3"), std::string::npos);
  EXPECT_NE(error_of("G0 X#1 Y1 Z0\n").find("X"), std::string::npos);
  EXPECT_NE(error_of("G0 X1 Y1\n").find("\"Z\""), std::string::npos);
  EXPECT_NE(error_of("G0 X1 Y1 Z0\nG2 X5 Y1 I9 J9\n").find("centre"), std::string::npos);
  EXPECT_NE(error_of("G90 G90.1\nG0 X1 Y1 Z0\nG2 X5 Y1 I3\n").find("\"J\""), std::string::npos);
  EXPECT_NE(error_of(corrected("G0 X1 Y1 Z0\n").text).find("part.ngc:1"), std::string::npos);
  const std::string arcs = corrected("G0 X300 Y150 Z-50\nG2 X300 Y150 I0 J50 F900\n", {0, 0, 0}, true).text;
  EXPECT_NE(arcs.find("G2 "), std::string::npos);
  EXPECT_NE(error_of(arcs).find("part.ngc:1"), std::string::npos);
}

TEST(PartPrograms, ArcsInInchesAreThoseInMillimetres) {
  const std::string head = "G90\nG0 X10 Y5 Z-2\nG2 X12 Y7 ";
  const PartProgram inch = corrected("G20 " + head + "I2 F40\n", {0, 0, 0}, true);
  const PartProgram mm =
      corrected("G21 G90\nG0 X254 Y127 Z-50.8\nG2 X304.8 Y177.8 I50.8 F1016\n", {0, 0, 0}, true);
  EXPECT_GT(inch.arcs, 0u);
  const std::vector<Vector3d> a = points_of(inch.text), b = points_of(mm.text);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LT((25.4 * a[k] - b[k]).norm(), 5e-5) << k;
}

TEST(PartPrograms, ArcsKeepTheirBlocksWordsAndTheCentreIsAlwaysAStep) {
  const PartProgram program = corrected(
      "G21 G90 G90.1\nG0 X300 Y150 Z-50\n/N7 G18 G2 X350 Z-100 I350 K-50 F900 (slow)\nG93 G17 G3 X350 Y150 "
      "I350 J200 F2\n",
      {0, 0, 0}, true);
  EXPECT_EQ(program.text.find("G90.1"), std::string::npos);
  EXPECT_NE(program.text.find("\nG21 G91.1\n"), std::string::npos);
  EXPECT_GT(program.arcs, 3u);
  double minutes = 0;
  bool timed = false;
  std::istringstream lines(program.text);
  for (std::string line; std::getline(lines, line);) {
    timed = timed || line.find("G93") != std::string::npos;
    if (line.find(" K") != std::string::npos) {
      // A block that may be skipped is skipped whole, and its plane's letters are those of its centre.
      EXPECT_EQ(line.front(), '/') << line;
      EXPECT_EQ(line.find(" J"), std::string::npos) << line;
    }
    if (timed && line.find(" F") != std::string::npos)
      minutes += 1 / std::stod(line.substr(line.find(" F") + 2));
  }
  EXPECT_NEAR(minutes, 0.5, 1e-4);
}

}  // namespace
}  // namespace vernier::offline_test
