// SPDX-License-Identifier: GPL-3.0-or-later
// The program and the rows of a test of positioning, and that its rows are what the evaluation reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "tools/evaluate/positioning.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/standard/positioning_test.h"
#include "tools/text/error.h"

namespace vernier::plan {
namespace {

model::Machine mill(double travel) {
  return model::parse_machine(
      "<machine name=\"mill\"><variables><static><BaseShift/></static><machineaxes><X min=\"0\" max=\"" +
          std::to_string(travel) +
          "\"/><Y min=\"-100\" max=\"300\"/><C rotary=\"true\" rollover=\"true\"/></machineaxes></variables>"
          "<transforms branch=\"workpiece\"><sixdof n=\"1\" rZ=\"C\"/></transforms>"
          "<transforms branch=\"tool\"><sixdof n=\"1\" Y=\"Y\"/><sixdof n=\"2\" "
          "X=\"X\"/></transforms></machine>",
      "mill.xml");
}

PositioningTestOptions of(const char* axis) {
  PositioningTestOptions options;
  options.axis = axis;
  return options;
}

TEST(PositioningTest, HasTheTargetsAndRunsOfTheStandard) {
  const struct {
    double travel;
    std::size_t targets, runs;
  } kAxes[] = {{300, 5, 5}, {816, 5, 5}, {1224, 7, 5}, {2040, 11, 5}, {5100, 21, 1}};
  for (const auto& axis : kAxes) {
    const PositioningTest test = positioning_test(mill(axis.travel), of("X"));
    EXPECT_EQ(test.targets.size(), axis.targets) << axis.travel;
    EXPECT_EQ(test.runs, axis.runs) << axis.travel;
    EXPECT_EQ(test.reading, "x");
  }
  const PositioningTest turn = positioning_test(mill(300), of("C"));
  EXPECT_EQ(turn.targets.size(), 8U);
  EXPECT_EQ(turn.targets.front(), 0);
  EXPECT_EQ(turn.targets.back(), 360);
  EXPECT_EQ(turn.reading, "rz");
}

TEST(PositioningTest, TargetsAreUnevenAndStayInOrder) {
  PositioningTestOptions options = of("X");
  options.targets = 25;
  const PositioningTest test = positioning_test(mill(1000), options);
  std::set<long> intervals;
  for (std::size_t i = 1; i < test.targets.size(); ++i) {
    const double step = test.targets[i] - test.targets[i - 1];
    EXPECT_GT(step, 0.3 * test.interval);
    EXPECT_LT(step, 1.7 * test.interval);
    intervals.insert(std::lround(100 * step));
  }
  EXPECT_GT(intervals.size(), 15U);
  // With a period the targets move by at most one period.
  options.period = 5;
  const PositioningTest screw = positioning_test(mill(1000), options);
  double most = 0;
  for (std::size_t i = 0; i < screw.targets.size(); ++i)
    most = std::max(most,
                    std::abs(screw.targets[i] - screw.targets[0] - static_cast<double>(i) * screw.interval));
  EXPECT_LE(most, 5.01);
  EXPECT_GT(most, 2.5);
}

TEST(PositioningTest, ProgramReachesEachTargetFromItsDirectionAndStaysInTheRange) {
  PositioningTestOptions options = of("X");
  options.at = "Y=120";
  const PositioningTest test = positioning_test(mill(600), options);
  std::istringstream program(positioning_test_gcode(mill(600), test));
  const std::regex move("G1 X(-?[0-9.]+) F5000.*"),
      reading("G4 P5 ; read: run ([0-9]+), target ([0-9]+), (.*)");
  std::smatch found;
  double before = -1, at = -1;
  std::size_t readings = 0;
  for (std::string line; std::getline(program, line);) {
    if (std::regex_match(line, found, move)) {
      before = at, at = std::stod(found[1]);
      EXPECT_GE(at, 0);
      EXPECT_LE(at, 600);
    } else if (std::regex_match(line, found, reading)) {
      ++readings;
      EXPECT_NEAR(at, test.targets[std::stoul(found[2]) - 1], 1e-4);
      EXPECT_EQ(at > before, found[3] == "forward") << line;
    }
  }
  EXPECT_EQ(readings, 2 * test.runs * test.targets.size());
  EXPECT_THAT(positioning_test_gcode(mill(600), test),
              testing::HasSubstr("G1 Y120 C0 F5000 ; the axes at rest"));
  options.dwell_s = 0;
  EXPECT_THAT(positioning_test_gcode(mill(600), positioning_test(mill(600), options)),
              testing::HasSubstr("M0 ; read: run 1, target 1, forward"));
}

TEST(PositioningTest, FilledRowsAreEvaluated) {
  const PositioningTest test = positioning_test(mill(600), of("X"));
  std::istringstream rows(positioning_test_csv(mill(600), test));
  std::string filled;
  for (std::string line; std::getline(rows, line); filled += line + "\n") {
    const auto empty = line.find(",,");
    if (line.starts_with("#") || empty == std::string::npos) continue;
    const double target = std::stod(line);
    const bool forward = line.find(",1,,") != std::string::npos;
    line.replace(empty, 2, "," + std::to_string(target + (forward ? 0.004 : -0.002)) + ",");
  }
  const evaluate::PositioningFile file = evaluate::read_positioning(filled, "x.csv", "X", "x");
  EXPECT_EQ(file.rows, 2 * test.runs * test.targets.size());
  const evaluate::PositioningResult result = evaluate::evaluate_positioning(file.readings);
  ASSERT_EQ(result.targets.size(), test.targets.size());
  EXPECT_NEAR(*result.reversal, 0.006, 1e-6);
}

TEST(PositioningTest, WrongRequestsAreRefused) {
  const auto message = [](const PositioningTestOptions& options) {
    try {
      static_cast<void>(positioning_test(mill(600), options));
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message(of("Z")), testing::HasSubstr("no axis of this name"));
  PositioningTestOptions options = of("X");
  options.from = 500, options.to = 400;
  EXPECT_THAT(message(options), testing::HasSubstr("leaves no travel"));
  options.from = 0, options.to = 600;
  EXPECT_THAT(message(options), testing::HasSubstr("from -6 to 606, which is outside its range"));
  options = of("X");
  options.at = "Y=400";
  EXPECT_THAT(message(options), testing::HasSubstr("outside its range"));
  options = of("X");
  options.targets = 1;
  EXPECT_THAT(message(options), testing::HasSubstr("2 to 500 targets"));
}

}  // namespace
}  // namespace vernier::plan
