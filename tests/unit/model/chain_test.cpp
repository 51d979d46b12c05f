// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/chain.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <sstream>

#include "tests/support/machines.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/station_table.h"
#include "tools/text/files.h"

namespace vernier::chain_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

const std::string kData = VERNIER_SOURCE_DIR "/tests/data/electroimpact/";

/// Electroimpact's published chain (SAE 2012, Rudberg) at the reference poses, to the six printed decimals.
TEST(Chain, ReproducesThePublishedForwardReference) {
  const Machine machine = read_machine(kData + "kinematic_before.xml");
  std::istringstream lines(read_file(kData + "forward_reference.csv"));
  std::string line;
  std::getline(lines, line);
  int poses = 0;
  while (std::getline(lines, line)) {
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    ASSERT_EQ(v.size(), 20U);
    States states = make_states(1, 7, {v[7]});
    for (std::size_t i = 0; i < 7; ++i) states.axis[i][0] = v[i];
    const Poses pose = forward(machine, states);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(pose.position(k, 0), v[8 + static_cast<std::size_t>(k)], 1e-6);
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(pose.rotation[0](k, j), v[11 + static_cast<std::size_t>(3 * k + j)], 1e-9);
    }
    ++poses;
  }
  EXPECT_EQ(poses, 7);
}

TEST(Chain, DerivativesOfEveryObservationAgreeWithDifferences) {
  constexpr unsigned kSeed = 20260101;
  std::mt19937_64 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  const Machine machine = support::full_machine();
  const Measurement m = support::full_measurement(machine, 40, random);
  const ParameterSet parameters(machine, {"a", "b"});
  ASSERT_EQ(parameters.size(), 5U + 18 + 8 + 6 + 12);
  EXPECT_EQ(without_station("table.X[100].rY"), "table.X.rY");
  EXPECT_EQ(without_station("BaseShift[s2].rZ"), "BaseShift[s2].rZ");
  support::expect_derivatives(machine, m, parameters);
}

/// A wrist with a ToolShift that carries a camera, a board, or a reflector.
constexpr const char* kWrist =
    R"XML(<machine><variables><static><a value="310" unit="mm"/><zero value="3" unit="deg"/>
  <BaseShift X="20" Y="-700" Z="90" rX="100" rY="-30" rZ="15"/>
  <ToolShift X="40" Y="-25" Z="60" rX="-70" rY="20" rZ="130"/></static>
  <machineaxes><A rotary="true"/><B rotary="true"/><C rotary="true"/></machineaxes></variables>
  <transforms><sixdof n="1" rZ="A+zero"/><sixdof n="2" X="a" rY="B"/><sixdof n="3" X="120" rX="C"/></transforms>
  </machine>)XML";

TEST(Chain, DerivativesWithAToolShiftAgreeWithDifferences) {
  const Machine machine = parse_machine(kWrist, "wrist.xml");
  const ParameterSet parameters(machine, {""});
  ASSERT_EQ(parameters.size(), 2U + 6 + 6);
  EXPECT_EQ(parameters[8].name, "ToolShift.X");
  const Measurement m = parse_measurement(
      "A[deg],B[deg],C[deg],bx[mm],by[mm],bz[mm],brx[deg],bry[deg],brz[deg],x[mm],y[mm],z[mm],rx[deg],ry[deg]"
      ","
      "rz[deg],length[mm],cx[mm],cy[mm],cz[mm],ax,ay,az,distance[mm],from\n"
      "10,20,30,1,2,3,10,-20,30,1,2,3,10,20,30,100,5,6,7,0,0.6,0.8,,\n"
      "-50,70,-110,1,2,3,170,5,9,1,2,3,-60,20,30,100,5,6,7,0.6,0,0.8,50,1\n",
      "m.csv", machine);
  support::expect_derivatives(machine, m, parameters);
}

// The board is the measuring frame: the reading is the inverse of what a six-degree tracker would read.
TEST(Chain, ABoardIsSeenWhereTheInverseOfTheToolIs) {
  const Machine machine = parse_machine(kWrist, "wrist.xml");
  const Measurement m = parse_measurement(
      "A[deg],B[deg],C[deg],x[mm],y[mm],z[mm],rx[deg],ry[deg],rz[deg],bx[mm],by[mm],bz[mm],brx[deg],bry[deg],"
      "brz[deg]\n10,20,30,0,0,0,0,0,0,0,0,0,0,0,0\n-80,5,140,0,0,0,0,0,0,0,0,0,0,0,0\n",
      "m.csv", machine);
  const Eigen::VectorXd p = predict(machine, m);
  for (Eigen::Index row = 0; row < 2; ++row) {
    const auto motion = [&](Eigen::Index at) {
      const Eigen::Vector3d vector = p.segment<3>(12 * row + at + 3) * std::numbers::pi / 180;
      Eigen::Isometry3d t(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
      t.pretranslate(p.segment<3>(12 * row + at).eval());
      return t;
    };
    EXPECT_LT(((motion(0) * motion(6)).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-9);
  }
}

TEST(Chain, RotationVectorFollowsTheMeasuredBranchAcrossHalfATurn) {
  const Machine machine = parse_machine(
      "<machine><variables><machineaxes><C rotary=\"true\"/></machineaxes></variables>"
      "<transforms><sixdof rZ=\"C\"/></transforms></machine>",
      "m.xml");
  const Measurement m =
      parse_measurement("C[deg],rz[deg]\n179,179.01\n181,180.99\n181,-179.01\n", "m.csv", machine);
  const Eigen::VectorXd predicted = predict(machine, m);
  EXPECT_NEAR(predicted[0], 179, 1e-9);
  EXPECT_NEAR(predicted[1], 181, 1e-9);
  EXPECT_NEAR(predicted[2], -179, 1e-9);
}

TEST(Chain, NamesTheRowWhereAnExpressionIsNotFinite) {
  const Machine machine = parse_machine(
      "<machine><variables><machineaxes><X/></machineaxes></variables>\n<transforms><sixdof "
      "X=\"1/X\"/></transforms></machine>",
      "m.xml");
  const Measurement m = parse_measurement("X[mm],x[mm]\n1,1\n0,0\n", "m.csv", machine);
  try {
    predict(machine, m);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("m.xml:2: \"1/X\""), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("row 2"), std::string::npos) << error.what();
  }
}

Table table_of(const std::vector<double>& loc, const std::vector<double>& value, Interpolation how,
               bool periodic) {
  Table table;
  table.interpolation = how;
  table.periodic = periodic;
  for (std::size_t i = 0; i < loc.size(); ++i) {
    Station station;
    station.loc = loc[i];
    station.value[0] = value[i];
    table.stations.push_back(station);
  }
  return table;
}

TEST(StationTable, HoldsItsEndsAndHitsItsStations) {
  for (const Interpolation how : {Interpolation::kLinear, Interpolation::kCubic}) {
    const Table table = table_of({-10, 0, 5, 20}, {1, 3, -2, 4}, how, false);
    const StationTable look(table);
    for (const Station& station : table.stations)
      EXPECT_NEAR(look.values(station.loc)[0], station.value[0], 1e-14);
    EXPECT_EQ(look.values(-11)[0], 1);
    EXPECT_EQ(look.values(1e6)[0], 4);
    EXPECT_EQ(look.slopes(21)[0], 0);
  }
  const Table single = table_of({3}, {7}, Interpolation::kCubic, false);
  EXPECT_EQ(StationTable(single).values(-100)[0], 7);
}

TEST(StationTable, LinearIsStraightBetweenStations) {
  const Table table = table_of({0, 10}, {1, 3}, Interpolation::kLinear, false);
  EXPECT_DOUBLE_EQ(StationTable(table).values(2.5)[0], 1.5);
  EXPECT_DOUBLE_EQ(StationTable(table).slopes(2.5)[0], 0.2);
}

/// Natural cubic spline through (0,0) (1,1) (2,0): M1 = -3, so s(0.5) = 0.5 + 3/16 = 0.6875.
TEST(StationTable, NaturalSplineAgreesWithTheHandCalculation) {
  const Table table = table_of({0, 1, 2}, {0, 1, 0}, Interpolation::kCubic, false);
  EXPECT_NEAR(StationTable(table).values(0.5)[0], 0.6875, 1e-14);
}

TEST(StationTable, PeriodicSplineFollowsASineAndRepeats) {
  std::vector<double> loc, value;
  for (int i = 0; i <= 24; ++i) {
    loc.push_back(15.0 * i);
    value.push_back(std::sin(15.0 * (i % 24) * M_PI / 180));
  }
  const Table table = table_of(loc, value, Interpolation::kCubic, true);
  const StationTable look(table);
  for (double angle = -400; angle < 800; angle += 7.3) {
    // Error of a cubic spline: h^4 / 384 * max |f''''| = (0.2618)^4 / 384 = 1.2e-5.
    EXPECT_NEAR(look.values(angle)[0], std::sin(angle * M_PI / 180), 2e-5);
    EXPECT_NEAR(look.values(angle)[0], look.values(angle + 360)[0], 1e-12);
  }
}

TEST(StationTable, WeightsGiveTheValues) {
  for (const bool periodic : {false, true})
    for (const Interpolation how : {Interpolation::kLinear, Interpolation::kCubic}) {
      const Table table = table_of({0, 3, 7, 12, 20}, {1, -1, 4, 2, 1}, how, periodic);
      const StationTable look(table);
      std::vector<std::pair<std::size_t, double>> weights;
      for (double x = -5; x < 26; x += 0.37) {
        look.weights(x, weights);
        double sum = 0;
        for (const auto& [i, w] : weights) sum += w * table.stations[i].value[0];
        EXPECT_NEAR(sum, look.values(x)[0], 1e-12);
      }
    }
}

}  // namespace
}  // namespace vernier::chain_test
