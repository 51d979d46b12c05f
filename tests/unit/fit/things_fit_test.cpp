// SPDX-License-Identifier: GPL-3.0-or-later
// Fits of rows that met unknown points and artefacts: what is found, and what the size rests on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "tools/fit/findings.h"
#include "tools/fit/fit.h"
#include "tools/maths/factors.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"

namespace vernier::things_fit_test {

using namespace vernier::fit;
namespace {

/// A plane arm of two joints, and a point between its reach. Lengths 300 and 200 mm; the true second is 0.5
/// longer, and the zero of the second joint is off by 0.1 deg.
constexpr double kFirst_mm = 300, kSecond_mm = 200.5, kZero_deg = 0.1, kNoise_mm = 0.002;
constexpr const char* kArm = R"XML(<machine name="arm"><variables>
  <static><a value="300" nominal="300" unit="mm"/><b value="200" nominal="200" unit="mm"/>
    <zero value="0" nominal="0" unit="deg"/></static>
  <machineaxes><P rotary="true" min="-180" max="180"/><Q rotary="true" min="-180" max="180"/></machineaxes>
  </variables><transforms branch="tool"><sixdof n="1" rZ="P"/><sixdof n="2" X="a"/><sixdof n="3" rZ="Q+zero"/>
    <sixdof n="4" X="b"/></transforms></machine>)XML";

/// Joint angles at which the true arm is at (x, y), elbow left or right.
std::string at(double x, double y, double elbow) {
  const double far = std::hypot(x, y), unit = 180 / std::numbers::pi;
  const double bend = std::acos((far * far - kFirst_mm * kFirst_mm - kSecond_mm * kSecond_mm) /
                                (2 * kFirst_mm * kSecond_mm)) *
                      elbow;
  const double first =
      std::atan2(y, x) - std::atan2(kSecond_mm * std::sin(bend), kFirst_mm + kSecond_mm * std::cos(bend));
  return fmt::format("{:.10f},{:.10f}", unit * first, unit * bend - kZero_deg);
}

/// Six points, each met eight times with either elbow. distance: of the first two points, in one row.
std::string survey(bool distance, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, kNoise_mm);
  std::string text = "P[deg],Q[deg],same,name,distance[mm],from,u[mm]\n";
  const std::array<std::array<double, 2>, 6> points = {
      {{250, 100}, {400, 0}, {300, -200}, {150, 150}, {420, 120}, {200, -100}}};
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int i = 0; i < 8; ++i) {
      const bool length = distance && p == 1 && i == 0;
      text += at(points[p][0] + noise(random), points[p][1] + noise(random), i % 2 == 0 ? 1 : -1) +
              fmt::format(",S{},n{}_{},{},{},{}\n", p, p, i,
                          length ? fmt::format("{:.9f}", std::hypot(150, 100)) : "", length ? "n0_0" : "",
                          kNoise_mm);
    }
  return text;
}

FitResult fitted(const std::string& rows, const FitOptions& options = {}) {
  const model::Machine machine = model::parse_machine(kArm, "arm.xml");
  return fit::fit(machine, model::parse_measurement(rows, "survey.csv", machine), options);
}
double value(const FitResult& result, const std::string& name) {
  return result.machine.statics[*result.machine.find_static(name)].value;
}
bool has(const FitResult& result, const std::string& code) {
  const auto& list = result.machine.fitted->findings;
  return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.code == code; });
}

TEST(FitOfThings, ADistanceOfTwoPointsGivesTheArmItsSize) {
  const FitResult result = fitted(survey(true, 3));
  ASSERT_TRUE(result.converged);
  ASSERT_TRUE(result.size);
  EXPECT_TRUE(result.size->known);
  EXPECT_EQ(result.size->from, "distances");
  EXPECT_FALSE(has(result, "size-unknown"));
  for (const ParameterEstimate& one : result.estimates) {
    const double truth = one.name == "a" ? kFirst_mm : one.name == "b" ? kSecond_mm : kZero_deg;
    EXPECT_LT(std::abs(one.value - truth), 3.5 * one.std) << one.name;
    EXPECT_LT(one.std, 0.01) << one.name;
  }
  ASSERT_EQ(result.things.size(), 6u);
  EXPECT_NEAR(result.things[1].place_mm.x(), 400, 3.5 * result.things[1].u_place_mm.x());
  EXPECT_EQ(result.things[1].touches, 8u);
}

// A larger arm meets larger points as well. The ratio of the lengths is found, the size stays at nominal.
TEST(FitOfThings, WithoutALengthTheSizeIsHeldAndSaid) {
  const FitResult result = fitted(survey(false, 3));
  ASSERT_TRUE(result.converged);
  EXPECT_FALSE(result.size->known);
  EXPECT_TRUE(has(result, "size-unknown"));
  EXPECT_NEAR(value(result, "b") / value(result, "a"), kSecond_mm / kFirst_mm, 5e-5);
  EXPECT_NEAR(value(result, "a"), kFirst_mm, 0.5) << "the noise does not shrink the arm";
  EXPECT_GT(result.estimates[0].std, 0.02) << "its uncertainty is what is plausible, not what the noise says";
}

TEST(FitOfThings, ChiSquareOverItsFreedomIsOne) {
  double sum = 0;
  constexpr int kSurveys = 20;
  for (std::uint64_t seed = 1; seed <= kSurveys; ++seed) {
    const FitResult result = fitted(survey(true, seed));
    sum += result.chi_square / result.freedom;
    EXPECT_LT(result.freedom, 6 * 8 * 3 + 1 - 6 * 3 + 0.5) << "the unknown points cost three readings each";
  }
  // z has no noise: two of three readings of a row do.
  EXPECT_NEAR(sum / kSurveys, 2.0 / 3, 0.07);
}

/// A mill with a squareness and a scale: unknown points or a ring, touched with a spherical tip.
constexpr double kMillNoise_mm = 0.0007, kRing_mm = 37.5, kTip_mm = 2.5, kScale_um_m = 60;
constexpr const char* kMill = R"XML(<machine name="mill"><variables>
  <static><sq value="0" nominal="0" unit="deg"/><kX value="0" nominal="0" unit="um/m"/>
    <kY value="0" nominal="0" unit="um/m"/><tip value="2.5" nominal="2.5" unit="mm" Hide="true"/></static>
  <machineaxes><X min="0" max="700"/><Y min="0" max="500"/><Z min="-400" max="0"/></machineaxes>
  <artefact name="ring" type="cylinder" radius="37.5mm" uradius="0.4um" nx="0" ny="0" nz="1" side="inside" tip="tip"/>
  </variables><transforms branch="tool"><sixdof n="1" X="X*(1+1e-6*kX)"/>
    <sixdof n="2" X="-sq*0.017453292519943295*Y" Y="Y*(1+1e-6*kY)"/><sixdof n="3" Z="Z"/></transforms></machine>)XML";

FitResult mill_fit(const std::string& rows) {
  const model::Machine machine = model::parse_machine(kMill, "mill.xml");
  return fit::fit(machine, model::parse_measurement(rows, "touches.csv", machine));
}

/// Each point is touched four times from the same side: the points follow every error of the machine.
TEST(FitOfThings, AParameterThatThePointsFollowIsNotMeasured) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0, kMillNoise_mm);
  std::uniform_real_distribution<double> across(60, 440);
  std::string rows = "X[mm],Y[mm],Z[mm],same,u[um]\n";
  for (int point = 0; point < 8; ++point) {
    const double x = across(random), y = across(random);
    for (int i = 0; i < 4; ++i)
      rows += fmt::format("{:.6f},{:.6f},{:.6f},P{},0.7\n", x + noise(random), y + noise(random),
                          -200 + noise(random), point);
  }
  const FitResult result = mill_fit(rows);
  ASSERT_TRUE(result.converged);
  for (const ParameterEstimate& one : result.estimates) {
    EXPECT_EQ(one.from, Origin::kPrior) << one.name;
    EXPECT_EQ(one.value, 0) << one.name << " follows the noise";
    EXPECT_GT(one.std, one.unit == "deg" ? 0.1 : 1000) << one.name << ": no residual limits it";
  }
}

/// Touches of a ring of known radius by a mill whose X scale is kScale_um_m. tip_mm: the true radius of the
/// tip.
std::string ring_touches(double tip_mm) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> noise(0, kMillNoise_mm);
  std::string rows = "X[mm],Y[mm],Z[mm],on,u[um]\n";
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * std::numbers::pi * i / 40, radius = kRing_mm - tip_mm + noise(random);
    rows += fmt::format("{:.6f},{:.6f},-200,ring,0.7\n",
                        (300 + radius * std::cos(angle)) / (1 + 1e-6 * kScale_um_m),
                        250 + radius * std::sin(angle));
  }
  return rows;
}

TEST(FitOfThings, ARingGivesTheScalesAndSaysThatTheTipIsExact) {
  const FitResult result = mill_fit(ring_touches(kTip_mm));
  ASSERT_TRUE(result.converged);
  ASSERT_TRUE(result.size);
  EXPECT_TRUE(result.size->known);
  EXPECT_EQ(result.size->from, "known radius");
  EXPECT_TRUE(has(result, "taken-as-exact"));
  for (const ParameterEstimate& one : result.estimates) {
    const double truth = one.name == "kX" ? kScale_um_m : 0;
    EXPECT_LT(std::abs(one.value - truth), 3.5 * one.std) << one.name;
    EXPECT_EQ(one.from, Origin::kData) << one.name;
  }
}

/// The second link has an offset of 40 mm across it and an angle, which are held: without a distance, the
/// size of the arm comes from it.
TEST(FitOfThings, AFixedLengthThatGivesTheSizeIsNamed) {
  std::string held = kArm;
  const auto replace = [&](const std::string& from, const std::string& to) {
    held.replace(held.find(from), from.size(), to);
  };
  replace(R"(<b value="200" nominal="200" unit="mm"/>)",
          R"(<b value="196" nominal="196" unit="mm"/><c value="40" nominal="40" unit="mm" Hide="true"/>)");
  replace(R"(<zero value="0" nominal="0" unit="deg"/>)",
          R"(<zero value="-11.415" nominal="-11.415" unit="deg" Hide="true"/>)");
  replace(R"(X="b")", R"(X="b" Y="c")");
  const model::Machine machine = model::parse_machine(held, "arm.xml");
  const FitResult result =
      fit::fit(machine, model::parse_measurement(survey(false, 3), "survey.csv", machine));
  ASSERT_TRUE(result.size);
  EXPECT_TRUE(result.size->known);
  EXPECT_EQ(result.size->fixed, std::vector<std::string>{"c"});
}

/// Repeated touches of points of uncertain places in two set-ups: the places follow what the touches of one
/// place have in common.
TEST(FitOfThings, ThePlacesOfPointsAreNoNoiseOfThePoses) {
  std::string machine_text = kMill;
  machine_text.replace(machine_text.find("<sq "), 0,
                       R"(<BaseShift setup="a"/><BaseShift setup="b" rZ="-90"/>)");
  std::string points;
  const std::array<std::array<double, 2>, 4> nominal = {{{-140, 0}, {140, 0}, {0, 170}, {0, -40}}};
  for (std::size_t k = 0; k < nominal.size(); ++k)
    points += fmt::format(R"(<artefact name="N{}" type="point" x="{}" y="{}" z="0" u="40um"/>)", k,
                          nominal[k][0], nominal[k][1]);
  machine_text.replace(machine_text.find("<artefact name=\"ring\""), 0, points);
  const model::Machine machine = model::parse_machine(machine_text, "mill.xml");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, kMillNoise_mm), drawing(0, 0.04);
    std::array<std::array<double, 3>, 4> place{};
    for (std::size_t k = 0; k < place.size(); ++k)
      place[k] = {nominal[k][0] + drawing(random), nominal[k][1] + drawing(random), drawing(random)};
    std::string rows = "X[mm],Y[mm],Z[mm],on,setup,u[um]\n";
    for (const char setup : {'a', 'b'})
      for (std::size_t k = 0; k < place.size(); ++k)
        for (int i = 0; i < 4; ++i) {
          const double x = setup == 'a' ? place[k][0] : -place[k][1],
                       y = setup == 'a' ? place[k][1] : place[k][0];
          rows += fmt::format("{:.6f},{:.6f},{:.6f},N{},{},0.7\n", 300 + x + noise(random),
                              300 + y + noise(random), -50 + place[k][2] + noise(random), k, setup);
        }
    const FitResult result = fit::fit(machine, model::parse_measurement(rows, "touches.csv", machine));
    ASSERT_TRUE(result.converged) << seed;
    EXPECT_LT(result.noise.pose, 1) << seed << ": in units of u";
  }
}

/// The bed of a printer: its slope is none of the machine's errors, and the machine file keeps it.
TEST(FitOfThings, ATouchedPlaneIsInTheRecord) {
  const std::string machine =
      R"XML(<machine name="printer"><variables><machineaxes><X/><Y/><Z/></machineaxes>
  <artefact name="bed" type="plane"/></variables>
  <transforms branch="tool"><sixdof n="1" X="X" Y="Y" Z="Z"/></transforms></machine>)XML";
  const model::Machine printer = model::parse_machine(machine, "printer.xml");
  std::string rows = "X[mm],Y[mm],Z[mm],on\n";
  for (const double x : {0, 100, 200})
    for (const double y : {0, 50, 150})
      rows += fmt::format("{},{},{:.6f},bed\n", x, y, 2 + 0.001 * x - 0.002 * y);
  const FitResult result = vernier::fit::fit(printer, model::parse_measurement(rows, "bed.csv", printer), {});
  ASSERT_TRUE(result.machine.fitted);
  ASSERT_EQ(result.machine.fitted->planes.size(), 1u);
  const std::string text = model::with_fit_record(machine, *result.machine.fitted);
  const model::Machine read = model::parse_machine(text, "fitted.xml");
  ASSERT_EQ(read.fitted->planes.size(), 1u);
  const model::FitRecord::Plane& plane = read.fitted->planes.front();
  EXPECT_EQ(plane.name, "bed");
  EXPECT_NEAR(-plane.normal[0] / plane.normal[2], 0.001, 1e-8);
  EXPECT_NEAR(-plane.normal[1] / plane.normal[2], -0.002, 1e-8);
  EXPECT_NEAR(plane.place_mm[2], 2 + 0.001 * plane.place_mm[0] - 0.002 * plane.place_mm[1], 1e-6);
}

/// Touches of a bed with a probe at `offset` beside the nozzle, and with the nozzle at one point if `nozzle`.
FitResult fit_of_probed_bed(double offset_mm, bool nozzle) {
  const model::Machine printer = model::parse_machine(
      R"XML(<machine name="printer"><variables><static><sag value="0" nominal="0" unit="mm"/></static>
  <machineaxes><X/><Y/><Z/></machineaxes>
  <inputs><probeX unit="mm" reference="0"/><probeY unit="mm" reference="0"/></inputs>
  <artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" X="X" Y="Y" Z="Z+sag*X*X/10000"/><sixdof n="2" X="probeX" Y="probeY"/></transforms></machine>)XML",
      "printer.xml");
  std::string rows = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on,u[mm]\n";
  for (const double x : {0, 50, 100, 150, 200})
    for (const double y : {0, 50, 150})
      rows += fmt::format("{},{},{:.6f},{},0,bed,0.005\n", x, y, 1e-5 * x * (200 - x), offset_mm);
  if (nozzle) rows += "100,50,0.1,0,0,bed,0.005\n";
  return vernier::fit::fit(printer, model::parse_measurement(rows, "bed.csv", printer), {});
}

TEST(FitOfThings, APlaneThatAProbeBesideTheToolTouchedIsSaidToBeTakenAsFlat) {
  EXPECT_TRUE(has(fit_of_probed_bed(-30, false), kFlatnessAssumed));
  EXPECT_TRUE(has(fit_of_probed_bed(-30, true), kFlatnessAssumed));
  EXPECT_FALSE(has(fit_of_probed_bed(0, false), kFlatnessAssumed));
}

/// The finding must not depend on the presence of other rows, but on what they read.
TEST(FitOfThings, OnlyReadingsAlongItsNormalShowTheBowOfATouchedPlane) {
  const model::Machine printer = model::parse_machine(
      R"XML(<machine name="printer"><variables><static><sag value="0" nominal="0" unit="mm"/>
  <EC0Y value="0" nominal="0" unit="rad"/></static><machineaxes><X/><Y/><Z/></machineaxes>
  <inputs><probeX unit="mm" reference="0"/><probeY unit="mm" reference="0"/></inputs>
  <artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" X="X-EC0Y*Y" Y="Y" Z="Z+sag*X*X/10000"/><sixdof n="2" X="probeX" Y="probeY"/></transforms></machine>)XML",
      "printer.xml");
  std::string bed = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on,distance[mm],from,z[mm],u[mm]\n";
  for (const double x : {0, 50, 100, 150, 200})
    for (const double y : {0, 50, 150})
      bed += fmt::format("{},{},{:.6f},-30,0,bed,,,,0.005\n", x, y, 1e-5 * x * (200 - x));
  const auto fitted = [&](const std::string& rows) {
    return vernier::fit::fit(printer, model::parse_measurement(bed + rows, "bed.csv", printer), {});
  };
  // Distances in a plane of one height, as of a printed square
  EXPECT_TRUE(has(fitted("30,30,0.2,0,0,,,,,0.02\n200,200,0.2,0,0,,240.4,16,,0.02\n30,200,0.2,0,0,,,,,0.02\n"
                         "200,30,0.2,0,0,,240.1,18,,0.02\n"),
                  kFlatnessAssumed));
  // Heights along one line, then over the whole bed
  std::string line, grid;
  for (const double x : {0, 100, 200}) {
    line += fmt::format("{},50,20,0,0,,,,20,0.005\n", x);
    for (const double y : {0, 75, 150}) grid += fmt::format("{},{},20,0,0,,,,20,0.005\n", x, y);
  }
  EXPECT_TRUE(has(fitted(line), kFlatnessAssumed));
  EXPECT_FALSE(has(fitted(grid), kFlatnessAssumed));
}

/// A bed mesh moves Z by the height of the bed only: the table of Z stays at 0 over its whole travel,
/// although the bed has a shape that the model does not contain.
TEST(FitOfThings, ATableOfAnAxisThatHardlyMovedStaysAtNominal) {
  const auto table = [](const std::string& axis, const std::string& columns) {
    std::string text = "<table axis=\"" + axis + "\" fit=\"" + columns + "\">";
    for (const int loc : {0, 50, 100, 150, 200, 250})
      text += fmt::format("<station loc=\"{}\" X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>", loc);
    return text + "</table>";
  };
  const model::Machine printer = model::parse_machine(
      R"XML(<machine name="printer"><variables><machineaxes><X min="0" max="250"/><Y min="0" max="250"/>
  <Z min="0" max="250"/></machineaxes><comptables>)XML" +
          table("X", "Z") + table("Y", "Z rY") + table("Z", "X Y Z rX rY rZ") +
          R"XML(</comptables><artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" Y="Y" X="lYx" Z="lYz" rX="rYx" rY="rYy" rZ="rYz"/>
  <sixdof n="2" X="X+lXx" Y="lXy" Z="lXz" rX="rXx" rY="rXy" rZ="rXz"/>
  <sixdof n="3" X="lZx" Y="lZy" Z="Z+lZz" rX="rZx" rY="rZy" rZ="rZz"/><sixdof n="4" Z="-100"/>
  </transforms></machine>)XML",
      "printer.xml");
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.003);
  std::string rows = "X[mm],Y[mm],Z[mm],on,u[mm]\n";
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 11; ++i) {
      const double xi = 0.2 * i - 1, eta = 0.2 * j - 1;
      const double z = 0.15 * (1 - xi * xi) + 0.08 * xi * eta + 0.1 * std::sin(3 * xi) * std::cos(4 * eta) +
                       0.1 * std::exp(-10 * (std::pow(xi - 0.4, 2) + std::pow(eta + 0.3, 2)));
      rows +=
          fmt::format("{},{},{:.4f},bed,0.002\n", 125 + 110 * xi, 125 + 110 * eta, 0.2 + z + noise(random));
    }
  const FitResult result =
      vernier::fit::fit(printer, model::parse_measurement(rows, "mesh.csv", printer), {});
  for (const ParameterEstimate& one : result.estimates) {
    if (one.name.rfind("table.Z", 0) != 0) continue;
    EXPECT_EQ(one.value, 0) << one.name;
    EXPECT_EQ(one.from, Origin::kPrior) << one.name;
    EXPECT_GT(one.std, 0) << one.name;
  }
}

/// An arm without length meets every point: nothing is left of the readings, and it is no result.
TEST(FitOfThings, AnArmThatCollapsedIsNoResult) {
  std::string text = kArm;
  for (const std::string length : {"<a value=\"300\"", "<b value=\"200\""})
    text.replace(text.find(length), length.size(), length.substr(0, 2) + " Hide=\"true\" value=\"0.001\"");
  const model::Machine arm = model::parse_machine(text, "arm.xml");
  const FitResult result =
      vernier::fit::fit(arm, model::parse_measurement(survey(false, 3), "s.csv", arm), {});
  EXPECT_NE(result.absurd.find("touches of unknown points agree best if the machine does not move"),
            std::string::npos)
      << result.absurd;
  EXPECT_TRUE(fitted(survey(true, 3)).absurd.empty());
}

/// Each point is touched from many positions of X, Z and B, and always from the same Y: nothing but the noise
/// of the touches speaks about the scale of Y, and it is least where Y does not move.
TEST(FitOfThings, OneAxisThatCollapsedIsNoResult) {
  // The set-up of a reflector is a parameter that the nominal machine has not.
  const model::Machine mill = model::parse_machine(
      R"XML(<machine name="mill"><variables><static><sy value="0" nominal="0" scale="1"/><BaseShift setup="t"/></static>
  <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><B rotary="true" min="-90" max="90"/><Z min="-300" max="0"/>
  </machineaxes></variables><transforms><sixdof n="1" X="X"/><sixdof n="2" Y="Y*(1+sy)"/><sixdof n="3" Z="Z"/>
  <sixdof n="4" rY="B"/><sixdof n="5" Z="-100"/></transforms></machine>)XML",
      "mill.xml");
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.001);
  std::string rows =
      "X[mm],Y[mm],Z[mm],B[deg],same,x[mm],setup,u[um]\n100,100,-100,0,,100,t,1\n200,100,-100,0,,200,t,1\n";
  for (const char* point : {"P", "Q"})
    for (int b = -50; b <= 50; b += 10) {
      const double turn = b * maths::kRadPerDeg;
      rows += fmt::format("{:.6f},{:.6f},{:.6f},{},{},,,1\n", 300 + 100 * std::sin(turn) + noise(random),
                          (*point == 'P' ? 200 : 300) + noise(random),
                          -250 + 100 * std::cos(turn) + noise(random), b, point);
    }
  const FitResult result = vernier::fit::fit(mill, model::parse_measurement(rows, "s.csv", mill), {});
  EXPECT_EQ(result.absurd.find("along Y the fitted machine moves the tool by"), 0u) << result.absurd;
  EXPECT_NE(result.absurd.find("by sy alone"), std::string::npos) << result.absurd;
  EXPECT_NE(result.absurd.find("Hold sy at its nominal value"), std::string::npos) << result.absurd;
}

/// A tool whose nominal place is on the last joint: at the start no reading shows the zero of this joint. The
/// tool that the fit finds is 36 mm beside the joint, and there the zero turns the tool: both are open then.
TEST(FitOfThings, AZeroThatOnlyTheFoundToolShowsIsNotHeldAsExact) {
  constexpr double kAcross_mm = 30, kBeside_mm = -20, kLastZero_deg = 0.08;
  std::string text = kArm;
  const auto put = [&](const std::string& before, const std::string& what) {
    text.insert(text.find(before), what);
  };
  put("</static>",
      "<tx value=\"0\" nominal=\"0\" unit=\"mm\"/><ty value=\"0\" nominal=\"0\" unit=\"mm\"/>"
      "<last value=\"0\" nominal=\"0\" unit=\"deg\"/>");
  put("</machineaxes>", "<R rotary=\"true\" min=\"-180\" max=\"180\"/>");
  put("</transforms>", "<sixdof n=\"5\" rZ=\"R+last\"/><sixdof n=\"6\" X=\"tx\" Y=\"ty\"/>");
  const model::Machine arm = model::parse_machine(text, "arm.xml");
  std::mt19937_64 random(29);
  std::normal_distribution<double> noise(0, kNoise_mm);
  std::uniform_real_distribution<double> turn(-120, 120);
  std::string rows = "P[deg],Q[deg],R[deg],same,name,distance[mm],from,u[mm]\n";
  const std::array<std::array<double, 2>, 3> points = {{{250, 100}, {390, 0}, {300, -150}}};
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int i = 0; i < 12; ++i) {
      const double way = turn(random), c = std::cos(way * maths::kRadPerDeg),
                   s = std::sin(way * maths::kRadPerDeg);
      const std::string arm_angles =
          at(points[p][0] - (c * kAcross_mm - s * kBeside_mm) + noise(random),
             points[p][1] - (s * kAcross_mm + c * kBeside_mm) + noise(random), i % 2 == 0 ? 1 : -1);
      double first = 0, second = 0;
      ASSERT_EQ(std::sscanf(arm_angles.c_str(), "%lf,%lf", &first, &second), 2);
      const bool length = p == 1 && i == 0;
      rows += arm_angles + fmt::format(",{:.10f},S{},n{}_{},{},{},{}\n",
                                       way - first - second - kZero_deg - kLastZero_deg, p, p, i,
                                       length ? fmt::format("{:.9f}", std::hypot(140, 100)) : "",
                                       length ? "n0_0" : "", kNoise_mm);
    }
  const FitResult result = vernier::fit::fit(arm, model::parse_measurement(rows, "s.csv", arm), {});
  ASSERT_TRUE(result.converged);
  for (const auto& [name, truth] : {std::pair{"tx", kAcross_mm}, {"ty", kBeside_mm}, {"b", kSecond_mm}}) {
    const auto one =
        std::find_if(result.estimates.begin(), result.estimates.end(),
                     [&, wanted = name](const ParameterEstimate& e) { return e.name == wanted; });
    ASSERT_NE(one, result.estimates.end());
    EXPECT_LT(std::abs(one->value - truth), 3.5 * one->std)
        << name << " " << one->value << " +- " << one->std;
  }
}

// A column with the other sign can agree with another machine: a zero that is half a turn off.
TEST(FitOfThings, AnotherMachineThanThatOfTheFileDoesNotHold) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kArm;
    text.replace(text.find(from), from.size(), to);
    const model::Machine arm = model::parse_machine(text, "arm.xml");
    return vernier::fit::fit(arm, model::parse_measurement(survey(true, 3), "s.csv", arm), {});
  };
  EXPECT_FALSE(has(fitted(survey(true, 3)), "far-from-nominal"));
  const FitResult turned = with("<zero value=\"0\" nominal=\"0\"", "<zero value=\"0\" nominal=\"80\"");
  ASSERT_TRUE(has(turned, "far-from-nominal"));
  const auto& list = turned.machine.fitted->findings;
  const auto found =
      std::find_if(list.begin(), list.end(), [](const auto& one) { return one.code == "far-from-nominal"; });
  EXPECT_EQ(found->text.find("The fit moved zero by -7"), 0u) << found->text;
  const FitResult shorter = with("<b value=\"200\" nominal=\"200\"", "<b value=\"200\" nominal=\"400\"");
  EXPECT_TRUE(has(shorter, "far-from-nominal"));
}

// The radius of one ball is uncertain once, also if the ball is touched at many places.
TEST(FitOfThings, OneBallAtManyPlacesHasOneRadius) {
  const auto std_of_scale = [](int places) {
    const model::Machine mill = model::parse_machine(
        R"XML(<machine name="mill"><variables><static><s value="0" nominal="0" scale="0.01"/>
  <tip value="3" unit="mm" Hide="true"/></static>
  <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
  <artefact name="ball" type="sphere" radius="12.5mm" uradius="5um" tip="tip"/></variables>
  <transforms><sixdof n="1" X="X*(1+s)" Y="Y*(1+s)" Z="Z*(1+s)"/></transforms></machine>)XML",
        "mill.xml");
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0, 0.0005);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    std::string rows = "X[mm],Y[mm],Z[mm],on,setup,u[um]\n";
    for (int place = 0; place < places; ++place) {
      const double x = 300 + 200 * anywhere(random), y = 200 + 100 * anywhere(random);
      for (int i = 0; i < 20; ++i) {
        const double turn = 0.7 * i, up = 0.05 + 0.045 * i, flat = std::sqrt(1 - up * up);
        rows += fmt::format(
            "{:.6f},{:.6f},{:.6f},ball,p{},0.5\n", x + 15.5 * flat * std::cos(turn) + noise(random),
            y + 15.5 * flat * std::sin(turn) + noise(random), -200 + 15.5 * up + noise(random), place);
      }
    }
    const FitResult result = vernier::fit::fit(mill, model::parse_measurement(rows, "s.csv", mill), {});
    EXPECT_EQ(result.things.size(), static_cast<std::size_t>(places));
    return std::sqrt(result.covariance(0, 0));
  };
  // 5 um of 15.5 mm.
  EXPECT_NEAR(std_of_scale(1), 323e-6, 40e-6);
  EXPECT_NEAR(std_of_scale(8), 323e-6, 20e-6);
}

TEST(FitOfThings, ARobustLossIsRefusedByName) {
  FitOptions options;
  options.loss = Loss::kHuber;
  try {
    fitted(survey(true, 3), options);
    FAIL() << "accepted";
  } catch (const text::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--loss"), std::string::npos) << error.what();
  }
}

TEST(FitOfThings, CeresFindsTheSamePlace) {
  FitOptions options;
  options.solver = Solver::kCeres;
  const FitResult one = fitted(survey(true, 5)), other = fitted(survey(true, 5), options);
  for (std::size_t i = 0; i < one.estimates.size(); ++i)
    EXPECT_NEAR(one.estimates[i].value, other.estimates[i].value, 0.02 * one.estimates[i].std);
}

}  // namespace
}  // namespace vernier::things_fit_test
