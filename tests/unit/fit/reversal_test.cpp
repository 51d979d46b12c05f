// SPDX-License-Identifier: GPL-3.0-or-later
// Reversal: one artefact of unknown errors at several orientations gives errors of the machine without a
// reference. And a fit that does not converge names the parameters.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"

namespace vernier::reversal_test {

using namespace vernier::fit;
namespace {

using Eigen::Vector2d;

constexpr double kSquareness_rad = 60e-6, kU_mm = 0.0005;
constexpr const char* kMill = R"XML(<machine name="mill"><variables>
  <static><C0Y value="0" nominal="0" unit="rad"/>{}</static>
  <machineaxes><X min="0" max="500"/><Y min="0" max="500"/></machineaxes>{}</variables>
  <transforms branch="tool"><sixdof n="1" X="X-Y*C0Y" Y="Y"/></transforms></machine>)XML";

/// A square of four balls, of which only the drawing is known: each coordinate may be wrong by 50 um.
constexpr std::array<std::array<double, 2>, 4> kBalls = {{{0, 0}, {300, 0}, {300, 300}, {0, 300}}};
std::string mill(const std::vector<int>& orientations) {
  std::string shifts, balls;
  for (const int deg : orientations)
    shifts += fmt::format(R"(<BaseShift setup="at{0}" rZ="{1}"/>)", deg, -deg);
  for (std::size_t i = 0; i < kBalls.size(); ++i)
    balls += fmt::format(R"(<artefact name="P{}" type="point" x="{}" y="{}" z="0" u="50um"/>)", i,
                         kBalls[i][0], kBalls[i][1]);
  return fmt::format(kMill, shifts, balls);
}

/// Each ball is met four times in each orientation of the square.
std::string survey(const std::vector<int>& orientations, std::mt19937_64& random) {
  std::normal_distribution<double> error(0, 0.03), noise(0, kU_mm);
  std::array<Vector2d, 4> balls;
  for (std::size_t i = 0; i < 4; ++i)
    balls[i] = Vector2d(kBalls[i][0] + error(random), kBalls[i][1] + error(random));
  std::string text = "X[mm],Y[mm],on,setup,u[um]\n";
  for (const int deg : orientations) {
    const double turn = (deg + 0.3 * error(random)) * 3.14159265358979 / 180;
    for (int pass = 0; pass < 4; ++pass)
      for (std::size_t i = 0; i < 4; ++i) {
        const Vector2d from_middle = balls[i] - Vector2d(150, 150);
        const double x = 250 + std::cos(turn) * from_middle.x() - std::sin(turn) * from_middle.y(),
                     y = 250 + std::sin(turn) * from_middle.x() + std::cos(turn) * from_middle.y();
        text += fmt::format("{:.6f},{:.6f},P{},at{},0.5\n", x + y * kSquareness_rad + noise(random),
                            y + noise(random), i, deg);
      }
  }
  return text;
}

const ParameterEstimate& squareness(const FitResult& result) { return result.estimates.front(); }

FitResult fitted(const std::vector<int>& orientations, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const model::Machine machine = model::parse_machine(mill(orientations), "mill.xml");
  return fit::fit(machine, model::parse_measurement(survey(orientations, random), "square.csv", machine));
}

TEST(Reversal, FourOrientationsOfAnUnknownSquareGiveTheSquareness) {
  constexpr int kSurveys = 60;
  int covered = 0;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= kSurveys; ++seed) {
    const FitResult result = fitted({0, 90, 180, 270}, seed);
    ASSERT_TRUE(result.converged) << seed;
    EXPECT_EQ(result.things.size(), 4u) << "one square in four set-ups";
    const double off = squareness(result).value - kSquareness_rad;
    EXPECT_LT(squareness(result).std, 2e-6);
    squares += std::pow(off / squareness(result).std, 2);
    covered += std::abs(off) <= 1.96 * squareness(result).std ? 1 : 0;
  }
  RecordProperty("rms_over_std_percent", static_cast<int>(100 * std::sqrt(squares / kSurveys)));
  // 95 % of 60: 50 or fewer would be a chance of 1 in 1000.
  EXPECT_GE(covered, 51);
  EXPECT_NEAR(std::sqrt(squares / kSurveys), 1, 0.3);
}

// In one orientation the squareness of the square and of the machine are one number.
TEST(Reversal, OneOrientationGivesOnlyTheSquarenessOfTheDrawing) {
  const FitResult result = fitted({0}, 1);
  EXPECT_GT(squareness(result).std, 50e-6);
}

/// A straightedge of unknown form beside X, then turned over: the machine's straightness is half the sum.
TEST(Reversal, AStraightedgeAndItsReverseGiveTheStraightness) {
  constexpr int kStations = 6;
  std::string stations, planes;
  for (int i = 0; i < kStations; ++i) {
    stations += fmt::format(R"(<station loc="{}" Y="0"/>)", 100 * i);
    planes += fmt::format(
        R"(<artefact name="S{0}" type="plane" x="{1}" y="0" z="0" u="50um" nx="0" ny="1" nz="0"/>)", i,
        100 * i);
  }
  const std::string text =
      R"XML(<machine name="slide"><variables><static><BaseShift setup="normal"/><BaseShift setup="reversed" rX="180"/></static>
      <machineaxes><X min="0" max="500"/><Y min="-10" max="10"/></machineaxes><comptables><table axis="X" fit="Y">)XML" +
      stations + "</table></comptables>" + planes +
      R"XML(</variables><transforms branch="tool"><sixdof n="1" X="X" Y="Y+lXy"/></transforms></machine>)XML";
  const model::Machine machine = model::parse_machine(text, "slide.xml");
  std::mt19937_64 random(5);
  std::normal_distribution<double> error(0, 0.01), noise(0, kU_mm);
  std::array<double, kStations> machine_mm{}, edge_mm{};
  for (int i = 1; i + 1 < kStations; ++i) {
    machine_mm[static_cast<std::size_t>(i)] = error(random);
    edge_mm[static_cast<std::size_t>(i)] = error(random);
  }
  std::string rows = "X[mm],Y[mm],on,setup,u[um]\n";
  for (const int side : {1, -1})
    for (int pass = 0; pass < 3; ++pass)
      for (std::size_t i = 0; i < kStations; ++i)
        rows +=
            fmt::format("{},{:.6f},S{},{},0.5\n", 100 * i, side * edge_mm[i] - machine_mm[i] + noise(random),
                        i, side > 0 ? "normal" : "reversed");
  const FitResult result = fit::fit(machine, model::parse_measurement(rows, "edge.csv", machine));
  ASSERT_TRUE(result.converged);
  const auto& table = result.machine.tables.front().stations;
  // The ends are a line of the set-up.
  const double first = table.front().value[1], slope = (table.back().value[1] - first) / (kStations - 1);
  for (std::size_t i = 1; i + 1 < kStations; ++i)
    EXPECT_NEAR(table[i].value[1] - first - slope * static_cast<double>(i), machine_mm[i], 0.0015) << i;
}

/// Four touches of one point with a robot of 22 unknown values.
TEST(Fit, ThatDoesNotConvergeNamesTheParameters) {
  const model::Machine machine = model::read_machine(VERNIER_SOURCE_DIR "/tables/machines/ur10e.xml");
  const model::Measurement rows = model::parse_measurement(
      "J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg],same,u[mm]\n"
      "24.0179,-121.1799,212.0008,-48.1853,-17.5328,-142.6758,A,0.02\n"
      "120.2390,-72.9284,141.9613,-61.6788,24.0110,149.8041,A,0.02\n"
      "119.2758,-71.7202,141.1076,-136.4818,-19.2220,110.5600,A,0.02\n"
      "23.0464,-232.2137,131.9980,58.2834,-22.8986,176.7244,A,0.02\n",
      "few.csv", machine);
  const FitResult result = fit::fit(machine, rows);
  ASSERT_FALSE(result.converged);
  const auto says = [&](const char* words) { return result.absurd.find(words) != std::string::npos; };
  EXPECT_TRUE(says("9 readings for 22 free parameters")) << result.absurd;
  EXPECT_TRUE(says("the readings do not determine")) << result.absurd;
  EXPECT_TRUE(says("--hold")) << result.absurd;
}

}  // namespace
}  // namespace vernier::reversal_test
