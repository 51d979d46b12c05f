// SPDX-License-Identifier: GPL-3.0-or-later
// The whole way on machines whose truth is known: truth -> compile -> firmware on the simulated machine ->
// error left.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "hal/sim/analogue_chain.h"
#include "tools/model/machine_reader.h"
#include "tools/simulate/simulate.h"
#include "tools/text/error.h"

namespace vernier::known_truth_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::text;
namespace {

/// A bridge machine with squareness (deg), backlash (mm), servo lag (s), thermal scale (1/K) and a table on
/// X; the axes may be in another order, and X may be limited.
constexpr const char* kBridge = R"xml(<machine name="bridge"><variables>
  <static><sq value="{sq}" nominal="0" unit="deg"/><bl value="{bl}" nominal="0" unit="mm"/>
    <delay value="{lag}" nominal="0" unit="s"/><cte value="{cte}" nominal="0"/></static>
  <machineaxes>{axes}</machineaxes>
  <inputs><T unit="degC" reference="20"/></inputs>
  <comptables><table axis="X">
    <station loc="0" X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/>
    <station loc="300" X="{table}" Y="0.005" Z="-0.004" rX="0.001" rY="-0.002" rZ="0.001"/>
    <station loc="600" X="-0.01" Y="0" Z="0.004" rX="0" rY="0.001" rZ="-0.001"/></table></comptables></variables>
  <transforms branch="tool">
    <sixdof n="1" X="0" Y="Y+cte*Y*(T-20)" Z="0" rX="0" rY="0" rZ="0"/>
    <sixdof n="2" X="X+lXx+bl*dirX-delay*vX+sin(sq)*Y" Y="lXy" Z="lXz" rX="rXx" rY="rXy" rZ="rXz"/>
    <sixdof n="3" X="0" Y="0" Z="Z" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

struct Bridge {
  double sq = 0.01, bl = 0, lag = 2e-4, cte = 1.1e-5, table = 0.01;
  std::string limits = R"(maxcorrection="0.2" maxslew="5")";
  bool other_order = false;

  std::string text() const {
    const std::string x = R"(<X rotary="false" min="0" max="600" )" + limits + "/>",
                      y = R"(<Y rotary="false" min="0" max="400" )" + limits + "/>",
                      z = R"(<Z rotary="false" min="-300" max="0" )" + limits + "/>";
    return fmt::format(kBridge, fmt::arg("sq", sq), fmt::arg("bl", bl), fmt::arg("lag", lag),
                       fmt::arg("cte", cte), fmt::arg("table", table),
                       fmt::arg("axes", other_order ? z + y + x : x + y + z));
  }
  Machine machine() const { return parse_machine(text(), "bridge.xml"); }
  std::unique_ptr<LoadedImage> image() const {
    return load_image(compile_machine(machine(), text(), {}).image, machine());
  }
};

/// 10 s through the working volume, warming by 5 degC; up to 80 mm/s.
Path volume_path() {
  std::string text = "t[s],X[mm],Y[mm],Z[mm],T[degC]\n";
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.005 * i;
    text += fmt::format("{},{},{},{},{}\n", t, 300 + 120 * std::sin(0.63 * t), 200 + 150 * std::cos(0.5 * t),
                        -150 + 100 * std::sin(0.8 * t), 20 + 0.5 * t);
  }
  return {text, "path.csv"};
}

/// What may be left: the proved bound of every axis and the second order of the small angles (1e-3 deg * 2e-3
/// deg at an arm of 400 mm is 0.25 nm; the thermal term times squareness less), together, in um a coordinate.
double allowed_um(const Bridge& bridge) {
  double bound = 0;
  for (const OutputBound& output : compile_machine(bridge.machine(), bridge.text(), {}).bounds)
    bound = std::max(bound, output.total_um);
  return bound + 0.001;
}

TEST(KnownTruth, WhatIsLeftIsTheBoundOfTheImage) {
  const Bridge bridge;
  const auto image = bridge.image();
  const SimulateResult result = simulate::simulate(bridge.machine(), *image, volume_path(), {});
  std::printf("before %.4f um, after %.5f um, max after %.5f um\n", result.rms_before_um, result.rms_after_um,
              result.max_after_um);
  EXPECT_EQ(result.states.count, 10001u);
  EXPECT_GT(result.rms_before_um, 3);
  EXPECT_EQ(result.loop.fault, Fault::kNone);
  EXPECT_EQ(result.loop.saturated, 0u);
  EXPECT_EQ(result.loop.not_active, 0u);
  // What the corrected axes cause in turn (the lever of a correction through the errors) is of second order
  // too.
  EXPECT_LT(result.rms_after_um, allowed_um(bridge) + 1e-3 * result.rms_before_um);
  // Not the double model in disguise: corrections are whole nanometres.
  EXPECT_GT(result.rms_after_um, 1e-5);
}

TEST(KnownTruth, BacklashLeavesOnlyTheTicksOfItsSlewing) {
  Bridge bridge;
  bridge.bl = 0.004;
  const SimulateResult result = simulate::simulate(bridge.machine(), *bridge.image(), volume_path(), {});
  // 8 um at 5 um a tick: one tick short at each of the two reversals of X.
  EXPECT_GT(result.loop.slewing, 0u);
  EXPECT_LE(result.loop.slewing, 6u);
  EXPECT_LT(result.max_after_um, 8.1);
  EXPECT_LT(result.rms_after_um, 0.1);
}

TEST(KnownTruth, ConverterLeavesItsStepOverRootTwelve) {
  const Bridge bridge;
  const auto image = bridge.image();
  for (const unsigned bits : {8u, 16u}) {
    LoopOptions options;
    options.dac_bits = bits;
    const SimulateResult result = simulate::simulate(bridge.machine(), *image, volume_path(), options);
    const double step_um = 1e-3 * AnalogueChain(bits).step_nm(), expected = step_um / std::sqrt(12.0);
    std::printf("%u bits: %.5f um, step/sqrt(12) %.5f um\n", bits, result.rms_after_um, expected);
    // The correction crosses many codes, so its rounding is evenly spread: within 15 %, and at 16 bits the
    // rest of the image (rounding to 1 nm) beside it.
    EXPECT_NEAR(result.rms_after_um, expected, 0.15 * expected + 0.001);
    EXPECT_EQ(result.loop.saturated, 0u);
  }
}

TEST(KnownTruth, ConverterThatIsTooShortIsCounted) {
  Bridge bridge;
  bridge.table = 0.15;  // 150 um at X = 300, the converter reaches 124.5
  LoopOptions options;
  options.dac_bits = 8;
  EXPECT_GT(simulate::simulate(bridge.machine(), *bridge.image(), volume_path(), options).loop.saturated,
            100u);
}

TEST(KnownTruth, MagnitudeLimitIsCounted) {
  Bridge bridge;
  bridge.limits = R"(maxcorrection="0.005" maxslew="5")";
  const SimulateResult result = simulate::simulate(bridge.machine(), *bridge.image(), volume_path(), {});
  EXPECT_GT(result.loop.saturated, 1000u);
  for (const Column& correction : result.loop.correction)
    EXPECT_LE(correction.abs().maxCoeff(), 0.005 + 1e-12);
}

TEST(KnownTruth, AxesOfTheTruthMayStandInAnotherOrder) {
  Bridge truth;
  truth.other_order = true;
  const Bridge compiled;
  const auto image = compiled.image();
  const SimulateResult a = simulate::simulate(truth.machine(), *image, volume_path(), {});
  const SimulateResult b = simulate::simulate(compiled.machine(), *image, volume_path(), {});
  EXPECT_NEAR(a.rms_before_um, b.rms_before_um, 1e-9);
  EXPECT_NEAR(a.rms_after_um, b.rms_after_um, 1e-9);
}

TEST(KnownTruth, ImageOfAnotherMachineDoesNotHelp) {
  // A metric that cannot fail is none: with squareness of the wrong sign the error must grow.
  Bridge truth, wrong;
  truth.cte = wrong.cte = 0, truth.lag = wrong.lag = 0, wrong.sq = -truth.sq;
  const SimulateResult result = simulate::simulate(truth.machine(), *wrong.image(), volume_path(), {});
  EXPECT_GT(result.rms_after_um, 1.1 * result.rms_before_um);
}

TEST(KnownTruth, ShiftedAndTurnedDatumIsNoError) {
  const Bridge bridge;
  const auto image = bridge.image();
  std::string text = bridge.text();
  const std::string first = R"(<transforms branch="tool">)";
  text.insert(text.find(first) + first.size(),
              R"(<sixdof n="0" X="12" Y="-3" Z="40" rX="0.3" rY="20" rZ="-5"/>)");
  const SimulateResult moved =
      simulate::simulate(parse_machine(text, "moved.xml"), *image, volume_path(), {});
  const SimulateResult plain = simulate::simulate(bridge.machine(), *image, volume_path(), {});
  EXPECT_NEAR(moved.rms_before_um, plain.rms_before_um, 1e-6);
  EXPECT_NEAR(moved.rms_after_um, plain.rms_after_um, 1e-6);
}

TEST(KnownTruth, LagOfTheTruthIsFollowedTickByTick) {
  const std::string text = R"xml(<machine name="lag"><variables>
    <static><k value="0.002" nominal="0" unit="mm/K"/></static>
    <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes>
    <inputs><T unit="degC" reference="20"/></inputs></variables>
    <transforms><sixdof n="1" X="X+k*lag(T-20,0.5)" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";
  const Machine machine = parse_machine(text, "lag.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  const Path path("t[s],X[mm],T[degC]\n0,100,20\n1,100,30\n3,100,22\n", "path.csv");
  const SimulateResult result = simulate::simulate(machine, *image, path, {});
  EXPECT_GT(result.rms_before_um, 2);
  EXPECT_LT(result.rms_after_um, 0.02);
}

TEST(KnownTruth, NoiseOfTheReadingsHardlyMatters) {
  // The gradient of the deviation is below 1e-3, so 10 um of noise move the correction by less than 10 nm.
  Bridge bridge;
  bridge.lag = 0;
  LoopOptions options;
  options.noise_um = 10;
  const auto image = bridge.image();
  const double quiet = simulate::simulate(bridge.machine(), *image, volume_path(), {}).rms_after_um;
  const SimulateResult noisy = simulate::simulate(bridge.machine(), *image, volume_path(), options);
  EXPECT_GT(noisy.rms_after_um, quiet);
  EXPECT_LT(noisy.rms_after_um, 0.01);
}

TEST(KnownTruth, AxisThatTheTruthLacksIsAnError) {
  const Bridge bridge;
  const Machine truth =
      parse_machine(R"xml(<machine name="t"><variables><machineaxes><X rotary="false"/></machineaxes>
    </variables><transforms><sixdof n="1" X="X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml",
                    "t.xml");
  EXPECT_THROW(simulate::simulate(truth, *bridge.image(), volume_path(), {}), InputError);
}

TEST(KnownTruth, SlewLimitBelowACountIsRefusedAndNotWaitedFor) {
  // 0.1 nm a tick: no whole count of the image, so the correction can never come in.
  Bridge bridge;
  bridge.limits = R"(maxcorrection="0.2" maxslew="0.0001")";
  EXPECT_THROW(simulate::simulate(bridge.machine(), *bridge.image(), volume_path(), {}), LimitNotMet);
}

}  // namespace
}  // namespace vernier::known_truth_test
