// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/compensator.h"

#include <gtest/gtest.h>

#include "comp/verify.h"

namespace vernier::compensator_test {
namespace {

/// One axis whose deviation is a quarter of its position: channel -> kLinear -> output, all in nm.
struct Quarter {
  Channel channels[1] = {{ChannelKind::kPosition, 0, 0, 0, 1, -1000000, 2000000, 0}};
  Instruction steps[1] = {{OpCode::kLinear, 2, 0, 0, 0, 1, 0}};
  Output outputs[1] = {{0, 1, 0, 1, 300000, 50000}};
  ValueRange ranges[kMaxRegisters] = {};

  Program program() const {
    Program p;
    p.equation.channel_count = 1;
    p.equation.instructions = {steps, 1};
    p.equation.result_count = 1;
    p.channels = {channels, 1};
    p.outputs = {outputs, 1};
    p.axis_count = 1;
    return p;
  }
};

CycleInput at(std::int64_t position) {
  CycleInput input;
  input.axis[0].position = AxisPosition(position);
  return input;
}

TEST(Compensator, CorrectsAgainstTheDeviation) {
  Quarter machine;
  machine.outputs[0].slew = INT32_MAX;
  ASSERT_EQ(verify_program(machine.program(), machine.ranges), ProgramFault::kNone);
  Compensator compensator(machine.program());
  const CycleOutput out = compensator.step(at(400000));
  EXPECT_EQ(out.correction[0].counts, -100000);
  EXPECT_EQ(length_of(out.correction[0]), LengthNm(-100000));
  EXPECT_EQ(out.flags, 0u);
}

TEST(Compensator, HoldsTheEdgeOneCountBeyondTheRangeAndSaysSo) {
  Quarter machine;
  machine.outputs[0] = {0, 1, 0, 1, INT32_MAX, INT32_MAX};
  Compensator compensator(machine.program());
  EXPECT_EQ(compensator.step(at(2000000)).flags, 0u);
  const CycleOutput beyond = compensator.step(at(2000001));
  EXPECT_EQ(beyond.flags, std::uint32_t{kBeyondRange});
  EXPECT_EQ(beyond.beyond_channels, 1u);
  EXPECT_EQ(beyond.correction[0].counts, -500000);
  EXPECT_EQ(compensator.step(at(INT64_MIN)).correction[0].counts, 250000);
  EXPECT_EQ(compensator.step(at(INT64_MAX)).correction[0].counts, -500000);
}

TEST(Compensator, LimitsMagnitudeThenSlew) {
  const Quarter machine;
  Compensator compensator(machine.program());
  CycleOutput out = compensator.step(at(2000000));  // wants -500000, may have -300000, moves 50000 a tick
  EXPECT_EQ(out.correction[0].counts, -50000);
  EXPECT_EQ(out.flags, std::uint32_t{kSaturated | kSlewing});
  for (int tick = 1; tick < 6; ++tick) out = compensator.step(at(2000000));
  EXPECT_EQ(out.correction[0].counts, -300000);
  EXPECT_EQ(out.flags, std::uint32_t{kSaturated});
}

TEST(Compensator, RampsByWeightAndStartsAgainFromZero) {
  Quarter machine;
  machine.outputs[0].slew = INT32_MAX;
  Compensator compensator(machine.program());
  EXPECT_EQ(compensator.step(at(800000), WeightQ16(16384)).correction[0].counts, -50000);
  EXPECT_EQ(compensator.step(at(800000), WeightQ16(0)).correction[0].counts, 0);
  EXPECT_EQ(compensator.step(at(800000), WeightQ16(INT32_MAX)).correction[0].counts, -200000);
  EXPECT_EQ(compensator.step(at(800000), WeightQ16(-5)).correction[0].counts, 0);
}

TEST(Compensator, ComesBackByWholeTurnsAtTheRollover) {
  Quarter machine;
  machine.channels[0] = {ChannelKind::kPosition, 0, 4, 0, 1, 0, kTurnCounts, kTurnCounts};
  machine.outputs[0] = {0, 1, 0, 1, INT32_MAX, INT32_MAX};
  ASSERT_EQ(verify_program(machine.program(), machine.ranges), ProgramFault::kNone);
  Compensator compensator(machine.program());
  const std::int32_t half = compensator.step(at(kTurnCounts / 2)).correction[0].counts;
  EXPECT_NE(half, 0);
  EXPECT_EQ(compensator.step(at(kTurnCounts * 7 + kTurnCounts / 2)).correction[0].counts, half);
  EXPECT_EQ(compensator.step(at(kTurnCounts / 2 - kTurnCounts * 3)).correction[0].counts, half);
  EXPECT_EQ(compensator.step(at(kTurnCounts + 64)).correction[0].counts,
            compensator.step(at(64)).correction[0].counts);
  EXPECT_EQ(compensator.step(at(INT64_MIN)).flags, 0u);
}

TEST(CorrectionFor, ChangesTheSignAndNothingElse) {
  EXPECT_EQ(correction_for(Deviation{17}).counts, -17);
  EXPECT_EQ(correction_for(Deviation{INT32_MIN}).counts, INT32_MAX);
}

}  // namespace
}  // namespace vernier::compensator_test
