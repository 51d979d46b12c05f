// SPDX-License-Identifier: GPL-3.0-or-later
// The tool's direction in the firmware loop: five axes, the B axis tilted by its published 0.0186 deg.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tools/model/machine_reader.h"
#include "tools/simulate/simulate.h"

namespace vernier::tilt_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::simulate;
namespace {

std::string machine_text(const std::string& correct, const std::string& limits) {
  return fmt::format(
      R"XML(<machine name="five"><variables><static><EA0B value="0.018575" nominal="0" unit="deg"/>
    <EX0B value="0.0294" nominal="0" unit="mm"/></static><machineaxes correct="{}"><X min="-300" max="300"/>
    <Y min="-300" max="300"/><Z min="0" max="800"/><B rotary="true" min="-90" max="90" {}/>
    <C rotary="true" min="-180" max="180" {}/></machineaxes></variables>
    <transforms branch="workpiece"><sixdof n="1" Y="-Y"/><sixdof n="2" rZ="C"/></transforms>
    <transforms branch="tool"><sixdof n="1" X="X"/><sixdof n="2" Z="Z"/><sixdof n="3" X="EX0B" rX="EA0B"/>
    <sixdof n="4" rY="B"/><sixdof n="5" Z="-499.889"/></transforms></machine>)XML",
      correct, limits, limits);
}

/// B from `first` to `last` deg while C turns by 180 and the slides move, 2 s.
Path sweep(double first, double last) {
  return {fmt::format("t[s],X[mm],Y[mm],Z[mm],B[deg],C[deg]\n0,-100,50,500,{},-90\n1,50,-50,550,{},0\n"
                      "2,100,100,600,{},90\n",
                      first, (first + last) / 2, last),
          "sweep.csv"};
}

SimulateResult run(const std::string& correct, const Path& path, const std::string& limits = {}) {
  const std::string text = machine_text(correct, limits);
  const Machine machine = parse_machine(text, "five.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  return simulate::simulate(machine, *image, path, {});
}

TEST(Tilt, IsTakenBackWhileTheRotaryAxesSweep) {
  const SimulateResult r = run("position orientation", sweep(10, 70));
  EXPECT_GT(r.tilt_before.maxCoeff(), 0.018);
  EXPECT_LE(r.tilt_after.maxCoeff(), 0.002);
  EXPECT_LE(r.max_after_um, 0.1);
  EXPECT_EQ(r.damped, 0u);
}

TEST(Tilt, StaysWherePositionAloneIsCorrected) {
  const SimulateResult r = run("position", sweep(10, 70));
  // A tilt about X shows in the direction by its share across it, largest at B = 10 deg.
  EXPECT_NEAR(r.tilt_after.maxCoeff(), 0.018575 * std::cos(10 * std::numbers::pi / 180), 1e-6);
  EXPECT_LE(r.max_after_um, 0.1);
  EXPECT_EQ(r.damped, 0u);
}

TEST(Tilt, ThroughTheSingularPoseIsDampedAndCounted) {
  const SimulateResult r = run("position orientation", sweep(-20, 20));
  // |sin B| < 1/16: 7.17 of 40 deg.
  EXPECT_NEAR(static_cast<double>(r.damped) / static_cast<double>(r.states.count), 0.179, 0.002);
  EXPECT_LE(r.tilt_after.maxCoeff(), 0.0187);
  EXPECT_LE(r.max_after_um, 0.1);
  const auto json = simulate_json(r, parse_machine(machine_text("position", ""), "five.xml"), {});
  EXPECT_EQ(json["damped"], r.damped);
  EXPECT_LE(json["tilt_after_deg"], json["tilt_before_deg"]);
  EXPECT_EQ(json["max_tilt_after_deg"], r.tilt_after.maxCoeff());
}

TEST(Tilt, LimitedTravelOfARotaryAxisCostsNoPosition) {
  const SimulateResult r = run("position orientation", sweep(-20, 20), "maxcorrection=\"0.05\"");
  EXPECT_LE(r.loop.correction[4].abs().maxCoeff(), 0.05);
  EXPECT_LE(r.max_after_um, 0.1);
}

}  // namespace
}  // namespace vernier::tilt_test
