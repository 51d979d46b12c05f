// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/compensator.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

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
  EXPECT_EQ(compensator.step(at(-1000000)).flags, 0u);
  EXPECT_EQ(compensator.step(at(-1000001)).flags, std::uint32_t{kBeyondRange});
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

TEST(Compensator, CorrectionOfExactlyTheLimitIsNotHeldByIt) {
  Quarter machine;
  machine.outputs[0].slew = INT32_MAX;
  Compensator compensator(machine.program());
  EXPECT_EQ(compensator.step(at(1200000)).flags, 0u);
  EXPECT_EQ(compensator.step(at(1200004)).flags, std::uint32_t{kSaturated});
  EXPECT_EQ(compensator.step(at(1200004)).correction[0].counts, -300000);
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

/// A machine whose deviation is one channel of a given kind.
CycleOutput after_channel(const Channel& channel, const CycleInput& input, const Output& output) {
  const Instruction copy{OpCode::kLinear, 0, 0, 0, 0, 1, 0};
  Program p;
  p.equation.channel_count = 1;
  p.equation.instructions = {&copy, 1};
  p.equation.result_count = 1;
  p.channels = {&channel, 1};
  p.outputs = {&output, 1};
  p.axis_count = 2;
  p.input_count = 2;
  ValueRange ranges[4] = {};
  EXPECT_EQ(verify_program(p, ranges), ProgramFault::kNone);
  return Compensator(p).step(input);
}

TEST(Compensator, ComesBackIntoARangeThatDoesNotBeginAtZero) {
  const Output output{0, 1, 0, 1, 1000, 1000};
  const Channel channel{ChannelKind::kPosition, 0, 0, 0, 1, -100, 155, 256};
  for (const auto& [position, expected] : {std::pair(-101, 155), std::pair(156, -100), std::pair(1000, -24)})
    EXPECT_EQ(after_channel(channel, at(position), output).correction[0].counts, -expected) << position;
}

TEST(Compensator, EachChannelHasItsOwnQuantity) {
  CycleInput input;
  input.axis[1].position = AxisPosition(10);
  input.axis[1].velocity = AxisSpeed(20);
  input.axis[1].acceleration = AxisAcceleration(30);
  input.axis[1].sense = -1;
  input.axis[1].since = AxisTravel(40);
  input.input[1] = InputMicro(50);
  input.feed = FeedNmPerMin(60);
  input.curvature = CurvatureNanoPerMm(70);
  input.time = TimeUs(80);
  input.visit = VisitCount(90);
  const Output output{0, 1, 0, 1, 1000, 1000};
  const std::int32_t expected[kChannelKindCount] = {10, 20, 30, -1, 40, 50, 60, 70, 80, 90};
  for (std::uint8_t kind = 0; kind < kChannelKindCount; ++kind) {
    const auto index =
        static_cast<std::uint8_t>(kind <= static_cast<std::uint8_t>(ChannelKind::kInput) ? 1 : 0);
    const Channel channel{static_cast<ChannelKind>(kind), index, 0, 0, 1, -100, 100, 0};
    EXPECT_EQ(after_channel(channel, input, output).correction[0].counts, -expected[kind]) << int{kind};
  }
  // Travel since a reversal has no end: its edge is held without a flag.
  input.axis[1].since = AxisTravel(1'000'000);
  const CycleOutput held = after_channel({ChannelKind::kSince, 1, 0, 0, 1, 0, 100, 0}, input, output);
  EXPECT_EQ(held.correction[0].counts, -100);
  EXPECT_EQ(held.flags & kBeyondRange, 0u);
  EXPECT_EQ(held.beyond_channels, 0u);
}

TEST(Compensator, DeviationBeyondInt32IsSaturatedAndSaysSo) {
  CycleInput input;
  input.axis[1].position = AxisPosition(3);
  const Channel channel{ChannelKind::kPosition, 1, 0, 0, 1, -10, 10, 0};
  const CycleOutput high = after_channel(channel, input, {0, 1, 0, 1 << 30, INT32_MAX, INT32_MAX});
  EXPECT_EQ(high.wanted[0].counts, -INT32_MAX);
  EXPECT_EQ(high.flags & kSaturated, kSaturated);
  input.axis[1].position = AxisPosition(-3);
  const CycleOutput low = after_channel(channel, input, {0, 1, 0, 1 << 30, INT32_MAX, INT32_MAX});
  EXPECT_EQ(low.wanted[0].counts, INT32_MAX);
  EXPECT_EQ(low.flags & kSaturated, kSaturated);
}

void half_of_the_channel(const std::int32_t* channel, LagState*, bool starting,
                         std::int32_t* deviation) noexcept {
  deviation[0] = starting ? 7 : channel[0] / 2;
}

TEST(Compensator, PrintedFormStandsInForTheProgram) {
  Quarter machine;
  machine.outputs[0] = {0, 1, 0, 1, INT32_MAX, INT32_MAX};
  Compensator compensator(machine.program());
  EXPECT_FALSE(compensator.printed());
  compensator.use_printed(half_of_the_channel);
  EXPECT_TRUE(compensator.printed());
  EXPECT_EQ(compensator.step(at(1000)).correction[0].counts, -7);
  EXPECT_EQ(compensator.step(at(1000)).correction[0].counts, -500);
  compensator.reset();
  EXPECT_EQ(compensator.step(at(1000)).correction[0].counts, -7) << "starting again";
  compensator.use_printed(nullptr);
  EXPECT_EQ(compensator.step(at(1000)).correction[0].counts, -250);
  compensator.start_from(0, Correction{90});
  machine.outputs[0].slew = 10;
  Compensator slow(machine.program());
  slow.start_from(0, Correction{90});
  EXPECT_EQ(slow.step(at(0)).correction[0].counts, 80);
}

void two_deviations(const std::int32_t* channel, LagState*, bool, std::int32_t* deviation) noexcept {
  deviation[0] = channel[0];
  deviation[1] = 2 * channel[0];
}

TEST(Compensator, PrintedFormFillsEachOutput) {
  const Channel channel{ChannelKind::kPosition, 0, 0, 0, 1, -1000, 1000, 0};
  const Instruction steps[2] = {{OpCode::kLinear, 0, 0, 0, 0, 1, 0}, {OpCode::kLinear, 0, 0, 0, 0, 2, 0}};
  const Output outputs[2] = {{1, 1, 0, 1, 1000, 1000}, {0, 2, 0, 1, 1000, 1000}};
  Program p;
  p.equation.channel_count = 1;
  p.equation.instructions = {steps, 2};
  p.equation.result_count = 2;
  p.channels = {&channel, 1};
  p.outputs = {outputs, 2};
  p.axis_count = 2;
  Compensator executed(p), printed(p);
  printed.use_printed(two_deviations);
  for (Compensator* compensator : {&executed, &printed}) {
    const CycleOutput out = compensator->step(at(100));
    EXPECT_EQ(out.correction[1].counts, -100);
    EXPECT_EQ(out.correction[0].counts, -200);
  }
}

TEST(Compensator, StateIsEmptyForMoreChannelsThanItHolds) {
  std::vector<Channel> channels(EquationState::kMostChannels + 1, {ChannelKind::kTime, 0, 0, 0, 1, 0, 9, 0});
  const Instruction copy{OpCode::kLinear, 0, 0, 0, 0, 1, 0};
  Program p;
  p.equation.channel_count = static_cast<std::uint32_t>(channels.size());
  p.equation.instructions = {&copy, 1};
  p.equation.result_count = 1;
  p.channels = {channels.data(), p.equation.channel_count};
  EquationState state;
  Compensator(p).state(state);
  EXPECT_EQ(state.channel_count, 0u);
  p.equation.channel_count = p.channels.size = EquationState::kMostChannels;
  Compensator(p).state(state);
  EXPECT_EQ(state.channel_count, EquationState::kMostChannels);
}

TEST(CorrectionFor, ChangesTheSignAndNothingElse) {
  EXPECT_EQ(correction_for(Deviation{17}).counts, -17);
  EXPECT_EQ(correction_for(Deviation{INT32_MIN}).counts, INT32_MAX);
}

}  // namespace
}  // namespace vernier::compensator_test
