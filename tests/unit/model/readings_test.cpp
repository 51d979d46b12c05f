// SPDX-License-Identifier: GPL-3.0-or-later
// Readings that are no coordinates: directions, distances between two rows, inclinations; and the labels that
// rows are grouped by.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/machines.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

namespace vernier::readings_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

using Eigen::Index;

const char* const kMachine = R"XML(<machine name="m"><variables>
  <static><sq value="0.05" nominal="0" unit="deg"/><len value="120.2" nominal="120" unit="mm"/>
    <BaseShift X="0.3" Y="-0.2" Z="0.1" rX="0.02" rY="0.03" rZ="-0.04"/>
    <BaseShift setup="second" X="5" Y="2" Z="1" rX="1" rY="2" rZ="30"/></static>
  <machineaxes><X min="0" max="400"/><Y min="0" max="300"/><B rotary="true" min="-90" max="90"/></machineaxes>
  <comptables><table axis="X" fit="X Y rY rZ"><station loc="0" X="0.01" rY="0.02"/><station loc="200" Y="0.02"
    rZ="0.03"/><station loc="400" X="-0.01"/></table></comptables></variables>
  <transforms branch="tool"><sixdof n="1" X="X+lXx" Y="lXy" rY="rXy" rZ="rXz+sq"/><sixdof n="2" Y="Y"/>
    <sixdof n="3" rY="B"/><sixdof n="4" Z="-len" rX="2"/></transforms></machine>)XML";

Machine machine() { return parse_machine(kMachine, "m.xml"); }
Measurement read(const std::string& text) { return parse_measurement(text, "m.csv", machine()); }
std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Rows at poses of a fixed seed; `cells` writes the rest of a row.
template <class Cells>
std::string rows(const std::string& header, int count, const Cells& cells) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::string text = "X[mm],Y[mm],B[deg]," + header + "\n";
  for (int i = 0; i < count; ++i)
    text += fmt::format("{:.1f},{:.1f},{:.1f},{}\n", 400 * share(random), 300 * share(random),
                        -80 + 160 * share(random), cells(i));
  return text;
}

void expect_derivatives(const Measurement& m) {
  const Machine machine = readings_test::machine();
  support::expect_derivatives(machine, m, ParameterSet(machine, m.states.names(m.states.setup)));
}

TEST(Directions, WeighAsTwoAnglesAgainstTheToolAxis) {
  // The tool points along z of its frame: at B = 0 that is turned by 2 deg about X, then by the set-up.
  const Measurement m =
      read("X[mm],Y[mm],B[deg],ax,ay,az,ua[arcsec],u[um]\n0,0,30,0.5,0,0.8660254,36,5\n0,0,30,,,,36,5\n");
  ASSERT_EQ(m.observations.size(), 2U);
  EXPECT_EQ(m.observations[0].kind, ObservationKind::kA1);
  EXPECT_EQ(m.observations[0].value, 0);
  EXPECT_DOUBLE_EQ(uncertainty_of(m, m.observations[0]), 0.01);
  const Eigen::VectorXd predicted = predict(machine(), m);
  // What is left of an ideal direction is the tilt of the last link, 2 deg, and small errors of the machine.
  EXPECT_NEAR(predicted.norm(), 2, 0.2);
  expect_derivatives(read(rows("ax,ay,az", 30, [](int i) {
    const double turn = 0.2 * i;
    return fmt::format("{:.6f},{:.6f},{:.6f}", 0.6 * std::cos(turn), 0.6 * std::sin(turn), 0.8);
  })));
}

TEST(Directions, ColumnsWithAUnitAreAnAccelerometers) {
  const Measurement m = read("X[mm],Y[mm],B[deg],x[mm],ax[g],ay[g],az[g]\n0,0,30,1,0.1,0,0.9\n");
  EXPECT_EQ(m.observations.size(), 1U);
  EXPECT_EQ(m.candidates.size(), 3U);
  EXPECT_NE(error_of("X[mm],Y[mm],B[deg],ax,ay,az\n0,0,30,1,1,1\n").find("m.csv:2"), std::string::npos);
}

TEST(Distances, AreBetweenTheToolPointsOfTwoRows) {
  const std::string text =
      "X[mm],Y[mm],B[deg],point,distance[mm],from,setup\n0,0,0,a,,,\n200,0,0,b,200.1,a,\n200,150,0,c,150,2,"
      "\n";
  const Measurement m = read(text);
  ASSERT_EQ(m.observations.size(), 2U);
  EXPECT_EQ(m.other_end[1], 0U);
  EXPECT_EQ(m.other_end[2], 1U);
  const Eigen::VectorXd predicted = predict(machine(), m);
  EXPECT_NEAR(predicted[0], 200, 0.2);
  EXPECT_NEAR(predicted[1], 150, 0.2);
  const Measurement without_b = select_rows(m, {0, 2});
  EXPECT_TRUE(without_b.observations.empty());  // both of b's distances are gone with it
  expect_derivatives(read(rows("distance[mm],from,setup", 30, [](int i) {
    return i == 0 ? std::string(",,") : fmt::format("100,{},{}", 1 + (i * 7) % i, i % 3 == 0 ? "second" : "");
  })));
  EXPECT_NE(error_of("X[mm],Y[mm],B[deg],distance[mm],from\n0,0,0,1,a\n").find("\"a\""), std::string::npos);
  EXPECT_NE(error_of("X[mm],Y[mm],B[deg],distance[mm],from\n0,0,0,1,1\n").find("the row itself"),
            std::string::npos);
}

TEST(Inclinations, AreTheToolsAxesAgainstTheHorizontal) {
  const Measurement m = read("X[mm],Y[mm],B[deg],ix[arcsec],iy[arcsec]\n0,0,10,0,0\n");
  const Eigen::VectorXd predicted = predict(machine(), m);
  EXPECT_NEAR(predicted[0], -10, 0.1);  // a turn about Y takes x down
  EXPECT_NEAR(predicted[1], 2 * std::cos(10 * M_PI / 180), 0.1);
  expect_derivatives(read(rows("ix[arcsec],iy[arcsec]", 30, [](int) { return "0,0"; })));
}

TEST(Groups, SetupClockAndBlockStandForThemselves) {
  const Measurement m = read(
      "X[mm],Y[mm],B[deg],x[mm],t[s],run,setup,clock,block\n0,0,0,1,0,a,,day,p\n1,0,0,1,5,b,second,day,p\n"
      "2,0,0,1,9,b,second,day,q\n3,0,0,1,2,b,second,night,q\n");
  const States& s = m.states;
  EXPECT_EQ(s.run_names.size(), 2U);
  EXPECT_EQ(s.visit[2], 2);  // of the clock, whatever the run
  EXPECT_EQ(s.visit[3], 0);
  EXPECT_EQ(s.names(s.block)[s.of(s.block, 2)], "q");
  require_time_order(m);  // t falls where another clock begins only
  const Eigen::VectorXd predicted = predict(machine(), m);
  EXPECT_LT(std::abs(predicted[0]), 20);
  EXPECT_GT(predicted[1], predicted[0] - 100);
  // A lag of the whole day is not broken where the run changes.
  Machine lagging = machine();
  const ExprPtr lag = parse_expression_for(lagging, "lag(X, 10)");
  const Column value = model::evaluate(lagging, *lag, s);
  EXPECT_GT(value[1], 0);
  EXPECT_LT(value[1], 1);
  EXPECT_EQ(value[3], 3);
}

TEST(Groups, AreTheRunWhereTheFileTellsNone) {
  const Measurement m = read("X[mm],Y[mm],B[deg],x[mm],run\n0,0,0,1,a\n1,0,0,1,second\n");
  EXPECT_EQ(m.states.of(m.states.setup, 1), 1U);
  EXPECT_EQ(m.states.names(m.states.setup)[1], "second");  // and the BaseShift of that name is its own
  const Eigen::VectorXd predicted = predict(machine(), m);
  EXPECT_GT(std::abs(predicted[1] - predicted[0]), 1.2);  // the commanded X differs by 1
  const Measurement one = select_rows(m, {1, 1, 0});
  EXPECT_EQ(one.observations.size(), 3U);
}

TEST(Groups, ComeTogetherFromFilesThatTellThemAndFilesThatDoNot) {
  Measurement all = read("X[mm],Y[mm],B[deg],x[mm],run\n0,0,0,1,a\n");
  append_measurement(all, read("X[mm],Y[mm],B[deg],x[mm],run,setup\n0,0,0,1,a,second\n1,0,0,2,b,a\n"));
  const States& s = all.states;
  EXPECT_EQ(s.names(s.setup)[s.of(s.setup, 0)], "a");
  EXPECT_EQ(s.names(s.setup)[s.of(s.setup, 1)], "second");
  EXPECT_EQ(s.of(s.setup, 2), s.of(s.setup, 0));
}

TEST(Labels, OfWordsAreKeptAndNumbersAreInputs) {
  const Measurement m = read("X[mm],Y[mm],B[deg],x[mm],operator,load[N]\n0,0,0,1,Ann,3\n1,0,0,1,,4\n");
  ASSERT_EQ(m.labels.size(), 1U);
  EXPECT_EQ(m.labels[0].value[0], "Ann");
  EXPECT_EQ(m.candidates.size(), 1U);
  EXPECT_NE(error_of("X[mm],Y[mm],B[deg],x[mm],n\n0,0,0,1,3\n1,0,0,1,four\n").find("four"),
            std::string::npos);
}

}  // namespace
}  // namespace vernier::readings_test
