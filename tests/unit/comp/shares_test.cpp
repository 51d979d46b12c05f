// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/shares.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace vernier::shares_test {
namespace {

/// A program of one channel: register 1 = 3 * X, register 2 = its lag. Shares: 2 * (3 X) of the first effect,
/// X / 2 of the second.
struct Sample {
  Channel channels[1] = {{ChannelKind::kPosition, 0, 0, 0, 1, -1000, 1000, 0}};
  Instruction steps[2] = {{OpCode::kLinear, 0, 0, 0, 0, 3, 0}, {OpCode::kLag, 31, 1, 0, 0, 1 << 30, 0}};
  Output outputs[1] = {{0, 1, 0, 1, 100'000, 100'000}};
  std::int32_t constants[1] = {2};
  std::uint16_t sources[2] = {1, 0};  // registers of the tick: 3 X and X
  Instruction own[1] = {{OpCode::kMultiply, 0, 0, 1, 0, 0, 0}};
  Share shares[2] = {{0, 3, 0, 1}, {0, 2, 1, 1}};
  std::uint32_t results = 1, channel_count = 2;
  ValueRange ranges[kMaxRegisters] = {};

  Program program() {
    Program p;
    p.equation = {{}, 1, {steps, 2}, {}, {}, {}, 1, 2};
    p.channels = {channels, 1};
    p.outputs = {outputs, 1};
    p.axis_count = 1;
    return p;
  }
  ShareProgram share_program() {
    return {{{constants, 1}, channel_count, {own, 1}, {}, {}, {}, 0, results}, {sources, 2}, {shares, 2}};
  }
  ProgramFault verify() {
    EXPECT_EQ(verify_program(program(), ranges), ProgramFault::kNone);
    return verify_shares(share_program(), program(), ranges);
  }
};

template <class Change>
ProgramFault after(const Change& change) {
  Sample s;
  change(s);
  return s.verify();
}

TEST(VerifyShares, AcceptsASoundProgramAndKnowsItsRanges) {
  Sample s;
  ASSERT_EQ(s.verify(), ProgramFault::kNone);
  EXPECT_EQ(s.ranges[3].low, 2);      // the constant
  EXPECT_EQ(s.ranges[4].high, 3000);  // 3 X
  EXPECT_EQ(s.ranges[6].low, -6000);
}

TEST(VerifyShares, NamesEveryCause) {
  constexpr auto kLong = ProgramFault::kTooLong;
  const auto with = [](auto change) {
    Sample s;
    EXPECT_EQ(verify_program(s.program(), s.ranges), ProgramFault::kNone);
    ShareProgram shares = s.share_program();
    change(shares);
    return verify_shares(shares, s.program(), s.ranges);
  };
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.constants.size = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.channel_count = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.result_count = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.result_count = kMaxRegisters - 5; }), kLong) << "together";
  // 2^32 registers less a few: with the registers of the tick their sum is a small number again.
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.constants.size = 0U - 3; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.channel_count = 0U - 3; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.result_count = 0U - 3; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.shares.size = kMaxShares + 1; }), kLong);
  EXPECT_EQ(with([](ShareProgram& p) { p.equation.channel_count = 1; }), ProgramFault::kChannel);
  EXPECT_EQ(after([](Sample& s) { s.results = 0; }), kLong) << "an instruction without a register";
  EXPECT_EQ(after([](Sample& s) { s.results = 2; }), kLong) << "a register without an instruction";
  EXPECT_EQ(after([](Sample& s) { s.sources[0] = 2; }), ProgramFault::kNone) << "the lag";
  EXPECT_EQ(after([](Sample& s) { s.sources[0] = 3; }), ProgramFault::kChannel)
      << "behind the tick's registers";
  for (const OpCode op : {OpCode::kWrap, OpCode::kLookUp, OpCode::kSineCosine, OpCode::kLag})
    EXPECT_EQ(after([op](Sample& s) { s.own[0].op = op; }), ProgramFault::kOpCode);
  EXPECT_EQ(after([](Sample& s) { s.own[0].b = 3; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.constants[0] = 1 << 20; }), ProgramFault::kOverflow);
}

TEST(VerifyShares, LargestProgramsAreAccepted) {
  Sample s;
  ASSERT_EQ(verify_program(s.program(), s.ranges), ProgramFault::kNone);
  const std::vector<Share> shares(kMaxShares, {0, 3, 0, 1});
  ShareProgram most = s.share_program();
  most.shares = {shares.data(), kMaxShares};
  EXPECT_EQ(verify_shares(most, s.program(), s.ranges), ProgramFault::kNone);
  // Behind the three registers of the tick: constants, two sources and one result.
  const std::uint32_t room = kMaxRegisters - 3 - 2 - 1;
  const std::vector<std::int32_t> constants(room + 1, 2);
  ShareProgram full = s.share_program();
  full.equation.constants = {constants.data(), room};
  EXPECT_EQ(verify_shares(full, s.program(), s.ranges), ProgramFault::kNone);
  full.equation.constants.size = room + 1;
  EXPECT_EQ(verify_shares(full, s.program(), s.ranges), ProgramFault::kTooLong);
}

TEST(VerifyShares, EachShareHasAnAxisASourceAndAFormat) {
  constexpr auto kOutput = ProgramFault::kOutput, kNone = ProgramFault::kNone;
  EXPECT_EQ(after([](Sample& s) { s.shares[1].axis = 1; }), kOutput);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].source = 4; }), kOutput);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].source = 3; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].shift = kMaxShift; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].shift = kMaxShift + 1; }), kOutput);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].multiplier = kMaxFactor; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].multiplier = kMaxFactor + 1; }), kOutput);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].multiplier = -kMaxFactor; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.shares[1].multiplier = -kMaxFactor - 1; }), kOutput);
}

TEST(RunShares, AreTheContributionsOfTheTick) {
  Sample s;
  ASSERT_EQ(s.verify(), ProgramFault::kNone);
  const Program program = s.program();
  Compensator compensator(program);
  CycleInput input;
  input.axis[0].position = AxisPosition(101);
  compensator.step(input);
  EquationState state;
  compensator.state(state);
  std::int32_t registers[kMaxRegisters];
  Correction corrections[2];
  EXPECT_EQ(state.starting, 1u);
  ASSERT_TRUE(run_shares(s.share_program(), program, state, registers, corrections));
  EXPECT_EQ(corrections[0].counts, -606);
  EXPECT_EQ(corrections[1].counts, -51);  // 50.5, rounded up, with the other sign
  EXPECT_EQ(registers[2], 303) << "the lag starts at its input";
  // One tick later the lag has a state.
  input.axis[0].position = AxisPosition(1);
  compensator.step(input);
  compensator.state(state);
  ASSERT_TRUE(run_shares(s.share_program(), program, state, registers, corrections));
  EXPECT_EQ(registers[2], compensator.register_value(2));
  EXPECT_EQ(registers[2], 153);
  state.channel_count = 2;
  EXPECT_FALSE(run_shares(s.share_program(), program, state, registers, corrections)) << "of another program";
}

/// A program with two constants, two channels and two lags: 5 X and 7 Y, each delayed. Shares: 11 and 13
/// times the two lags.
struct TwoOfEach {
  std::int32_t constants[2] = {5, 7};
  Channel channels[2] = {{ChannelKind::kPosition, 0, 0, 0, 1, -1000, 1000, 0},
                         {ChannelKind::kPosition, 1, 0, 0, 1, -1000, 1000, 0}};
  Instruction steps[4] = {{OpCode::kMultiply, 0, 0, 2, 0, 0, 0},     // 4
                          {OpCode::kMultiply, 0, 1, 3, 0, 0, 0},     // 5
                          {OpCode::kLag, 31, 4, 0, 0, 1 << 30, 0},   // 6
                          {OpCode::kLag, 31, 5, 1, 0, 1 << 30, 0}};  // 7
  Output outputs[2] = {{0, 6, 0, 1, 100'000, 100'000}, {1, 7, 0, 1, 100'000, 100'000}};
  std::int32_t own_constants[2] = {11, 13};
  std::uint16_t sources[2] = {6, 7};
  Instruction own[2] = {{OpCode::kMultiply, 0, 0, 2, 0, 0, 0}, {OpCode::kMultiply, 0, 1, 3, 0, 0, 0}};
  Share shares[3] = {{0, 4, 0, 1}, {1, 5, 0, 1}, {1, 5, 0, 1}};  // two are in use

  Program program() {
    Program p;
    p.equation = {{constants, 2}, 2, {steps, 4}, {}, {}, {}, 2, 4};
    p.channels = {channels, 2};
    p.outputs = {outputs, 2};
    p.axis_count = 2;
    return p;
  }
  ShareProgram share_program() {
    return {{{own_constants, 2}, 2, {own, 2}, {}, {}, {}, 0, 2}, {sources, 2}, {shares, 2}};
  }
};

TEST(RunShares, RestoreEveryConstantChannelAndLagOfTheTick) {
  TwoOfEach s;
  const Program program = s.program();
  ValueRange ranges[kMaxRegisters] = {};
  ASSERT_EQ(verify_program(program, ranges), ProgramFault::kNone);
  ASSERT_EQ(verify_shares(s.share_program(), program, ranges), ProgramFault::kNone);
  EXPECT_EQ(ranges[8].low, 11);
  EXPECT_EQ(ranges[9].high, 13);
  EXPECT_EQ(ranges[12].high, 11 * 5 * 1000);
  EXPECT_EQ(ranges[13].high, 13 * 7 * 1000);
  Compensator compensator(program);
  CycleInput input;
  input.axis[0].position = AxisPosition(2), input.axis[1].position = AxisPosition(3);
  compensator.step(input);
  input.axis[0].position = AxisPosition(4), input.axis[1].position = AxisPosition(5);
  compensator.step(input);
  EquationState state;
  compensator.state(state);
  std::int32_t registers[kMaxRegisters] = {};
  Correction corrections[3] = {{1}, {2}, {3}};
  ASSERT_TRUE(run_shares(s.share_program(), program, state, registers, corrections));
  // The lags go half of the way: from 10 to 20, and from 21 to 35.
  EXPECT_EQ(corrections[0].counts, -11 * 15);
  EXPECT_EQ(corrections[1].counts, -13 * 28);
  EXPECT_EQ(corrections[2].counts, 3) << "behind the last share nothing is written";
}

}  // namespace
}  // namespace vernier::shares_test
