// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/verify.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "comp/sine.h"

namespace vernier::verify_test {
namespace {

constexpr std::int32_t kHalf = INT32_MIN;  // the word of a reciprocal of 2^31

/// Two constants, one channel, tables of two pieces (linear with two columns and a grid, cubic with one), a
/// wrap, a sum of products, a sine and a lag.
struct Sample {
  std::int32_t constants[2] = {1 << 20, -5};
  Channel channels[1] = {{ChannelKind::kPosition, 0, 0, 0, 1, -1000, 1000, 0}};
  std::int32_t linear[16] = {0,      1 << 8, kHalf, 9, 5, 1, 6,  -13,  //
                             1 << 8, 1 << 8, kHalf, 9, 6, 0, -7, 2};
  std::int32_t cubic[16] = {0, 1 << 8, kHalf, 9, 1, 2, 3, 4, 1 << 8, 1 << 8, kHalf, 9, 5, 6, 7, 8};
  ErrorTable tables[2] = {{linear, 2, 2, 1, std::uint32_t{1} << 31, 39}, {cubic, 2, 1, 3, 0, 0}};
  Wrap wraps[1] = {{0, 1 << 10, 1 << 30, 40}};
  ProductTerm terms[3] = {{4, 0, 0}, {5, 6, 1}, {0, 1, 3}};
  Instruction steps[6] = {
      {OpCode::kWrap, 0, 2, 0, 0, 0, 0},               // 3
      {OpCode::kLookUp, 0, 3, 0, 0, 0, 0},             // 4, 5
      {OpCode::kLookUp, 0, 3, 1, 0, 0, 0},             // 6
      {OpCode::kSineCosine, 30, 3, 0, 0, 1 << 30, 0},  // 7, 8
      {OpCode::kDot, 3, 2, 1, 4, 100, 0},              // 9
      {OpCode::kLag, 40, 9, 0, 0, 1 << 30, 0},         // 10
  };
  Output outputs[1] = {{0, 10, 0, 1, 100, 100}};
  std::uint32_t results = 8;
  ValueRange ranges[kMaxRegisters] = {};

  ProgramFault verify() {
    Program p;
    p.equation = {{constants, 2}, 1, {steps, 6}, {terms, 3}, {tables, 2}, {wraps, 1}, 1, results};
    p.channels = {channels, 1};
    p.outputs = {outputs, 1};
    p.axis_count = 1;
    return verify_program(p, ranges);
  }
};

TEST(VerifyProgram, AcceptsASoundProgramAndKnowsItsRanges) {
  Sample s;
  ASSERT_EQ(s.verify(), ProgramFault::kNone);
  EXPECT_EQ(s.ranges[4].low, 5);
  EXPECT_EQ(s.ranges[4].high, 6);
  EXPECT_EQ(s.ranges[5].low, -7);
  EXPECT_EQ(s.ranges[5].high, 6);
  EXPECT_EQ(s.ranges[6].low, 1);
  EXPECT_EQ(s.ranges[6].high, 26);
  EXPECT_EQ(s.ranges[7].high, kSineLimit);
  // 100 * 16 + [5, 6] * 2^20 + ([-7, 6] * [1, 26] >> 1) + (5 * 2^20 >> 3), over 8.
  EXPECT_EQ(s.ranges[9].low, (1600 + 5 * 1048576 - 91 + 655360 + 4) >> 3);
  EXPECT_EQ(s.ranges[9].high, (1600 + 6 * 1048576 + 78 + 655360 + 4) >> 3);
}

template <class Change>
ProgramFault after(const Change& change) {
  Sample s;
  change(s);
  return s.verify();
}

TEST(VerifyProgram, NamesEveryCause) {
  EXPECT_EQ(after([](Sample& s) { s.channels[0].index = 1; }), ProgramFault::kChannel);
  EXPECT_EQ(after([](Sample& s) { s.channels[0].low = 2000; }), ProgramFault::kChannel);
  EXPECT_EQ(after([](Sample& s) { s.channels[0].multiplier = 0; }), ProgramFault::kChannel);
  EXPECT_EQ(after([](Sample& s) { s.channels[0].wrap = 3; }), ProgramFault::kChannel);
  EXPECT_EQ(after([](Sample& s) { s.channels[0].multiplier = 1 << 30; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.linear[1] = 0; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.linear[8] += 1; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.linear[2] += 1; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.linear[3] = 34; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[0].columns = 0; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[0].degree = 2; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[0].pieces = 0; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[1].pieces = 0; }), ProgramFault::kTable)
      << "a table without a grid";
  EXPECT_EQ(after([](Sample& s) { s.tables[0].grid_multiplier /= 2; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[0].grid_shift = 64; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[1].grid_shift = 1; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].period = 0; }), ProgramFault::kWrap);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].reciprocal /= 2; }), ProgramFault::kWrap);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].op = static_cast<OpCode>(200); }), ProgramFault::kOpCode);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].a = 3; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].b = 1; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[1].b = 2; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].l = -1; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].a = 3; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].a = s.steps[4].b = 0; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.terms[2].b = 9; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.terms[0].a = 900; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.terms[0].shift = 63; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].c = 32; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].shift = 62; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[3].k = 0; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[5].shift = 30; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[4].k = INT32_MIN, s.steps[4].c = 31; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) {
              s.terms[0] = {7, 7, 0}, s.terms[1] = {7, 8, 0};
            }),
            ProgramFault::kOverflow);  // far beyond 32 bits after its shift of 3
  EXPECT_EQ(after([](Sample& s) { s.linear[4] = INT32_MAX; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.cubic[6] = INT32_MAX; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.results = 7; }), ProgramFault::kTooLong);
  EXPECT_EQ(after([](Sample& s) { s.results = 9; }), ProgramFault::kTooLong);
  EXPECT_EQ(after([](Sample& s) { s.results = kMaxRegisters; }), ProgramFault::kTooLong);
  EXPECT_EQ(after([](Sample& s) { s.steps[5].b = 1; }), ProgramFault::kLag);
  EXPECT_EQ(after([](Sample& s) {
              s.steps[4] = s.steps[5];
              s.steps[4].a = 6;
            }),
            ProgramFault::kLag);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].source = 11; }), ProgramFault::kOutput);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].axis = 1; }), ProgramFault::kOutput);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].slew = -1; }), ProgramFault::kOutput);
}

// An image is verified before it is trusted: its last result must not be written behind the memory.
TEST(VerifyProgram, WritesNoRangeBehindTheRegisters) {
  Sample s;
  s.results = 7;  // the last step would be number 10
  const ValueRange mark{-77, 77};
  for (std::uint32_t i = 10; i < kMaxRegisters; ++i) s.ranges[i] = mark;
  EXPECT_EQ(s.verify(), ProgramFault::kTooLong);
  for (std::uint32_t i = 10; i < kMaxRegisters; ++i) {
    EXPECT_EQ(s.ranges[i].low, mark.low) << i;
    EXPECT_EQ(s.ranges[i].high, mark.high) << i;
  }
}

/// A program of one instruction on two channels with given ranges; the range of its result.
struct OneStep {
  Channel channels[2];
  std::int32_t constants[1] = {1};
  ProductTerm terms[4] = {{1, 2, 0}, {1, 1, 0}, {2, 2, 0}, {1, 2, 62}};
  std::int32_t linear[8] = {0, 256, kHalf, 9, 5, 1, 6, -13};
  ErrorTable tables[1] = {{linear, 1, 2, 1, 0, 0}};
  Wrap wraps[1] = {{0, 1 << 10, 1 << 30, 40}};
  Instruction step;
  Output outputs[2] = {{0, 0, 0, 1, 100, 100}, {1, 0, 0, 1, 100, 100}};
  std::uint32_t outputs_used = 1, lags = 0, results = 1, axes = 2, inputs = 0;
  ValueRange ranges[kMaxRegisters] = {};

  OneStep(ValueRange a, ValueRange b, const Instruction& one)
      : channels{{ChannelKind::kPosition, 0, 0, 0, 1, a.low, a.high, 0},
                 {ChannelKind::kPosition, 1, 0, 0, 1, b.low, b.high, 0}},
        step(one) {}
  Program program() {
    Program p;
    p.equation = {{constants, 1}, 2, {&step, 1}, {terms, 4}, {tables, 1}, {wraps, 1}, lags, results};
    p.channels = {channels, 2};
    p.outputs = {outputs, outputs_used};
    p.axis_count = axes;
    p.input_count = inputs;
    return p;
  }
  ProgramFault verify() { return verify_program(program(), ranges); }
};

constexpr std::int64_t kLow32 = INT32_MIN, kHigh32 = INT32_MAX;

ProgramFault fault_of(ValueRange a, ValueRange b, const Instruction& step) {
  return OneStep(a, b, step).verify();
}
std::pair<std::int64_t, std::int64_t> range_after(ValueRange a, ValueRange b, const Instruction& step) {
  OneStep one(a, b, step);
  EXPECT_EQ(one.verify(), ProgramFault::kNone);
  return {one.ranges[3].low, one.ranges[3].high};
}
Instruction on_both(OpCode op, unsigned shift = 0, std::int32_t k = 0, std::int32_t l = 0) {
  return {op, static_cast<std::uint8_t>(shift), 1, 2, 0, k, l};
}

TEST(VerifyProgram, RangesOfEachOperationAreThoseOfAllItsOperands) {
  using Range = std::pair<std::int64_t, std::int64_t>;
  EXPECT_EQ(range_after({-4, 5}, {2, 3}, on_both(OpCode::kLinear, 1, 3, -2)), Range(-9, 6));
  EXPECT_EQ(range_after({-4, 5}, {-2, 3}, on_both(OpCode::kMultiply)), Range(-12, 15));
  EXPECT_EQ(range_after({-4, -2}, {-3, -2}, on_both(OpCode::kMultiply)), Range(4, 12));
  EXPECT_EQ(range_after({2, 3}, {4, 5}, on_both(OpCode::kMultiply)), Range(8, 15));
  EXPECT_EQ(range_after({2, 4}, {0, 0}, on_both(OpCode::kAbs)), Range(2, 4));
  EXPECT_EQ(range_after({-4, -2}, {0, 0}, on_both(OpCode::kAbs)), Range(2, 4));
  EXPECT_EQ(range_after({-4, 2}, {0, 0}, on_both(OpCode::kAbs)), Range(0, 4));
  EXPECT_EQ(range_after({-4, 8}, {1, 5}, on_both(OpCode::kMin)), Range(-4, 5));
  EXPECT_EQ(range_after({-4, 8}, {1, 5}, on_both(OpCode::kMax)), Range(1, 8));
  EXPECT_EQ(range_after({1, 8}, {0, 0}, on_both(OpCode::kSign)), Range(1, 1));
  EXPECT_EQ(range_after({0, 0}, {0, 0}, on_both(OpCode::kSign)), Range(0, 0));
  EXPECT_EQ(range_after({-8, -1}, {0, 0}, on_both(OpCode::kSign)), Range(-1, -1));
  EXPECT_EQ(range_after({-8, 1}, {0, 0}, on_both(OpCode::kSign)), Range(-1, 1));
  EXPECT_EQ(range_after({1, 8}, {0, 0}, on_both(OpCode::kEqual)), Range(0, 1));
  EXPECT_EQ(range_after({1, 8}, {0, 0}, on_both(OpCode::kLess)), Range(0, 1));
  EXPECT_EQ(range_after({kLow32, kHigh32}, {0, 0}, {OpCode::kWrap, 0, 1, 0, 0, 0, 0}), Range(0, 1023));
  EXPECT_EQ(range_after({-4, 5}, {-2, 3}, {OpCode::kDot, 0, 1, 1, 0, 0, 0}), Range(-12 - 25, 15 + 20));
}

// For each operation the largest operands that it may have, and one count more.
TEST(VerifyProgram, RefusesTheFirstCountThatCouldLeaveTheRegister) {
  constexpr auto kNone = ProgramFault::kNone, kOver = ProgramFault::kOverflow;
  const Instruction abs = on_both(OpCode::kAbs), multiply = on_both(OpCode::kMultiply);
  EXPECT_EQ(fault_of({-kHigh32, 0}, {0, 0}, abs), kNone);
  EXPECT_EQ(fault_of({kLow32, 0}, {0, 0}, abs), kOver);
  EXPECT_EQ(fault_of({0, 1 << 16}, {0, (1 << 15) - 1}, multiply), kNone);
  EXPECT_EQ(fault_of({0, 1 << 16}, {0, 1 << 15}, multiply), kOver);
  EXPECT_EQ(fault_of({0, 1 << 16}, {-(1 << 15), 0}, multiply), kNone);
  EXPECT_EQ(fault_of({0, 1 << 16}, {-(1 << 15) - 1, 0}, multiply), kOver);
  EXPECT_EQ(fault_of({0, kHigh32}, {0, 0}, on_both(OpCode::kLinear, 0, 1, 1)), kNone);
  EXPECT_EQ(fault_of({0, kHigh32}, {0, 1}, on_both(OpCode::kLinear, 0, 1, 1)), kOver);
  EXPECT_EQ(fault_of({kLow32, 0}, {0, 1}, on_both(OpCode::kLinear, 0, 1, -1)), kOver);
  // 2^62 is one more than a sum of products may reach, in either direction.
  EXPECT_EQ(fault_of({kLow32, kLow32 + 1}, {kLow32, kLow32 + 1}, {OpCode::kDot, 32, 1, 0, 0, 0, 0}), kOver);
  EXPECT_EQ(fault_of({kLow32, kLow32 + 1}, {kLow32, kLow32 + 1}, {OpCode::kDot, 32, 0, 1, 0, 0, 0}), kOver);
  EXPECT_EQ(fault_of({kLow32 + 1, 0}, {kLow32 + 1, 0}, {OpCode::kDot, 32, 1, 0, 0, 0, 0}), kNone);
  EXPECT_EQ(fault_of({kLow32 + 1, 0}, {kLow32 + 1, 0}, {OpCode::kDot, 32, 0, 1, 0, 0, 0}), kNone);
}

TEST(VerifyProgram, FactorsAndShiftsAreWithinTheirLimits) {
  constexpr auto kNone = ProgramFault::kNone, kShift = ProgramFault::kShift;
  const ValueRange small{-1, 1};
  for (const auto& [k, expected] : {std::pair(kMaxFactor, kNone), std::pair(kMaxFactor + 1, kShift),
                                    std::pair(-kMaxFactor, kNone), std::pair(-kMaxFactor - 1, kShift)}) {
    EXPECT_EQ(fault_of(small, small, on_both(OpCode::kLinear, 0, k, 0)), expected) << k;
    EXPECT_EQ(fault_of(small, small, on_both(OpCode::kLinear, 0, 0, k)), expected) << k;
  }
  EXPECT_EQ(fault_of(small, small, on_both(OpCode::kAbs, kMaxShift)), kNone);
  EXPECT_EQ(fault_of(small, small, on_both(OpCode::kAbs, kMaxShift + 1)), kShift);
  EXPECT_EQ(fault_of(small, small, {OpCode::kDot, 0, 1, 0, 31, 0, 0}), kNone);
  EXPECT_EQ(fault_of(small, small, {OpCode::kDot, 0, 1, 0, 32, 0, 0}), kShift);
  EXPECT_EQ(fault_of(small, small, {OpCode::kDot, 0, 1, 0, 0, 0, 3}), kNone);  // a term with shift 62
  OneStep sine(small, small, {OpCode::kSineCosine, 0, 1, 0, 0, 1, 0});
  sine.results = 2;
  EXPECT_EQ(sine.verify(), kNone);
  EXPECT_EQ(sine.ranges[3].low, -kSineLimit);
  EXPECT_EQ(sine.ranges[4].high, kSineLimit);
  sine.step.k = -1;
  EXPECT_EQ(sine.verify(), kShift);
  OneStep lag(small, small, {OpCode::kLag, 31, 1, 0, 0, 0, 0});
  lag.lags = 1;
  EXPECT_EQ(lag.verify(), kNone);
  lag.step.k = -1;
  EXPECT_EQ(lag.verify(), kShift);
  lag.step = {OpCode::kLag, 30, 1, 0, 0, 0, 0};
  EXPECT_EQ(lag.verify(), kShift);
}

TEST(VerifyProgram, OperandsExistBeforeTheyAreRead) {
  constexpr auto kOperand = ProgramFault::kOperand;
  const ValueRange small{-1, 1};
  for (const OpCode op :
       {OpCode::kLinear, OpCode::kMultiply, OpCode::kMin, OpCode::kMax, OpCode::kEqual, OpCode::kLess}) {
    Instruction step = on_both(op);
    step.b = 3;
    EXPECT_EQ(fault_of(small, small, step), kOperand);
    step = on_both(op);
    step.a = 3;
    EXPECT_EQ(fault_of(small, small, step), kOperand);
  }
  Instruction one_operand = on_both(OpCode::kAbs);
  one_operand.b = 900;
  EXPECT_EQ(fault_of(small, small, one_operand), ProgramFault::kNone) << "b has no meaning here";
  EXPECT_EQ(fault_of(small, small, {OpCode::kDot, 0, 1, 0, 0, 0, 4}), kOperand) << "behind the last term";
  EXPECT_EQ(fault_of(small, small, {OpCode::kWrap, 0, 1, 1, 0, 0, 0}), kOperand);
  EXPECT_EQ(fault_of(small, small, {static_cast<OpCode>(kOpCodeCount), 0, 1, 2, 0, 0, 0}),
            ProgramFault::kOpCode);
  OneStep term(small, small, {OpCode::kDot, 0, 1, 0, 0, 0, 0});
  term.terms[0].a = 3;
  EXPECT_EQ(term.verify(), kOperand);
  term.terms[0] = {1, 3, 0};
  EXPECT_EQ(term.verify(), kOperand);
  OneStep look_up(small, small, {OpCode::kLookUp, 0, 1, 1, 0, 0, 0});
  look_up.results = 0;
  EXPECT_EQ(look_up.verify(), kOperand) << "a table that does not exist";
}

TEST(VerifyProgram, SizesFitTheMemoryOfTheCycle) {
  constexpr auto kLong = ProgramFault::kTooLong, kNone = ProgramFault::kNone;
  const auto with = [](auto change) {
    OneStep one({-1, 1}, {-1, 1}, on_both(OpCode::kAbs));
    Program p = one.program();
    change(p);
    return verify_program(p, one.ranges);
  };
  const ErrorTable table{};
  EXPECT_EQ(with([](Program&) {}), kNone);
  EXPECT_EQ(with([](Program& p) { p.equation.constants.size = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.channel_count = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.instructions.size = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.result_count = kMaxRegisters + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.result_count = kMaxRegisters - 2; }), kLong) << "together";
  // One size alone, whose sum with the others begins at zero again.
  EXPECT_EQ(with([](Program& p) { p.equation.constants.size = UINT32_MAX - 2; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.channel_count = UINT32_MAX - 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.result_count = UINT32_MAX - 2; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.lag_count = kMaxLags + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.axis_count = kMaxAxes + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.axis_count = kMaxAxes; }), kNone);
  EXPECT_EQ(with([](Program& p) { p.input_count = kMaxInputs + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.input_count = kMaxInputs; }), kNone);
  EXPECT_EQ(with([&](Program& p) { p.equation.tables = {&table, kMaxTables + 1}; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.equation.terms.size = kMaxTerms + 1; }), kLong);
  EXPECT_EQ(with([](Program& p) { p.channels.size = 1; }), ProgramFault::kChannel);
  EXPECT_EQ(with([](Program& p) { p.equation.lag_count = 1; }), ProgramFault::kLag)
      << "a lag that nothing uses";
}

// A program as large as the memory of the cycle is sound: the limits are what is there, not one less.
TEST(VerifyProgram, LargestProgramsAreAccepted) {
  constexpr auto kNone = ProgramFault::kNone;
  ValueRange ranges[kMaxRegisters];
  const std::vector<std::int32_t> constants(kMaxRegisters, 3);
  const std::vector<Channel> channels(kMaxRegisters, {ChannelKind::kTime, 0, 0, 0, 1, -1, 1, 0});
  Program p;
  p.equation.constants = {constants.data(), kMaxRegisters};
  EXPECT_EQ(verify_program(p, ranges), kNone) << "constants alone";
  p = {};
  p.channels = {channels.data(), kMaxRegisters};
  p.equation.channel_count = kMaxRegisters;
  EXPECT_EQ(verify_program(p, ranges), kNone) << "channels alone";
  std::vector<Instruction> lags;
  for (std::uint32_t i = 0; i < kMaxLags; ++i)
    lags.push_back({OpCode::kLag, 31, 0, static_cast<std::uint16_t>(i), 0, 1, 0});
  p.equation.constants = {constants.data(), kMaxRegisters - kMaxLags};
  p.equation.channel_count = p.channels.size = 0;
  p.equation.instructions = {lags.data(), kMaxLags};
  p.equation.lag_count = p.equation.result_count = kMaxLags;
  EXPECT_EQ(verify_program(p, ranges), kNone) << "all lags, and constants in all other registers";
  const Sample sample;
  const std::vector<ErrorTable> tables(kMaxTables, {sample.linear, 2, 2, 1, 0, 0});
  const std::vector<ProductTerm> terms(kMaxTerms, {0, 0, 0});
  p.equation.tables = {tables.data(), kMaxTables};
  p.equation.terms = {terms.data(), kMaxTerms};
  EXPECT_EQ(verify_program(p, ranges), kNone) << "all tables and terms";
  std::vector<std::int32_t> record(kSegmentWords + 2 * kMaxRegisters, 1);
  record[0] = 0, record[1] = 256, record[2] = kHalf, record[3] = 9;
  const ErrorTable widest{record.data(), 1, kMaxRegisters, 1, 0, 0};
  p.equation.tables = {&widest, 1};
  EXPECT_EQ(verify_program(p, ranges), kNone) << "a table of as many columns as there are registers";
}

TEST(VerifyProgram, ChannelsHaveASourceAndAFormat) {
  constexpr auto kChannel = ProgramFault::kChannel, kNone = ProgramFault::kNone;
  constexpr std::int64_t kFar = std::int64_t{1} << 60;
  const auto with = [](auto change, std::uint32_t inputs = 0) {
    OneStep one({-1, 1}, {-1, 1}, on_both(OpCode::kAbs));
    one.inputs = inputs;
    change(one.channels[0]);
    return one.verify();
  };
  EXPECT_EQ(with([](Channel& c) { c.kind = static_cast<ChannelKind>(kChannelKindCount); }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.index = 2; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.kind = ChannelKind::kSince, c.index = 1; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.kind = ChannelKind::kInput, c.index = 1; }, 1), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.kind = ChannelKind::kInput, c.index = 1; }, 2), kNone);
  EXPECT_EQ(with([](Channel& c) { c.kind = ChannelKind::kVisit, c.index = 1; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.kind = ChannelKind::kVisit; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.low = c.high = 1; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.low = 2; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.low = -kFar, c.pre_shift = 40; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.low = -kFar + 1, c.pre_shift = 40; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.high = kFar, c.pre_shift = 40; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.high = kFar - 1, c.pre_shift = 40; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.pre_shift = 41; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.shift = kMaxShift; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.shift = kMaxShift + 1; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.multiplier = -1; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.wrap = -2; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.wrap = kFar; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.wrap = kFar / 2; }), kNone);
  EXPECT_EQ(with([](Channel& c) { c.wrap = 6; }), kChannel) << "no power of two";
  EXPECT_EQ(with([](Channel& c) { c.high = kHigh32 + 1; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.low = kLow32 - 1; }), kChannel);
  EXPECT_EQ(with([](Channel& c) { c.low = kLow32, c.high = kHigh32; }), ProgramFault::kOverflow) << "|low|";
  EXPECT_EQ(with([](Channel& c) { c.low = kLow32, c.multiplier = 2; }), ProgramFault::kOverflow);
  EXPECT_EQ(with([](Channel& c) { c.high = kHigh32, c.multiplier = 2; }), ProgramFault::kOverflow);
}

TEST(VerifyProgram, OutputsAreOneForAnAxisAndWithinTheirLimits) {
  constexpr auto kOutput = ProgramFault::kOutput, kNone = ProgramFault::kNone;
  const auto with = [](auto change) {
    OneStep one({-1, 1}, {-1, 1}, on_both(OpCode::kAbs));
    one.outputs_used = 2;
    change(one);
    return one.verify();
  };
  EXPECT_EQ(with([](OneStep&) {}), kNone);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].axis = 0; }), kOutput) << "twice";
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].axis = 2; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].source = 3; }), kNone);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].source = 4; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].shift = kMaxShift; }), kNone);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].shift = kMaxShift + 1; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].limit = -1; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].limit = s.outputs[1].slew = 0; }), kNone);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].slew = -1; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].multiplier = kMaxFactor + 1; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].multiplier = -kMaxFactor - 1; }), kOutput);
  EXPECT_EQ(with([](OneStep& s) { s.outputs[1].multiplier = -kMaxFactor; }), kNone);
}

TEST(VerifyProgram, TablesAndPeriodsAreSoundAtEachLimit) {
  constexpr auto kTable = ProgramFault::kTable, kWrap = ProgramFault::kWrap, kNone = ProgramFault::kNone;
  EXPECT_EQ(after([](Sample& s) { s.tables[0].columns = kMaxRegisters + 1; }), kTable);
  EXPECT_EQ(after([](Sample& s) { s.tables[1].degree = 1; }), kTable) << "records of another length";
  EXPECT_EQ(after([](Sample& s) { s.linear[0] = INT32_MAX - 255; }), kTable) << "its end is beyond int32";
  EXPECT_EQ(after([](Sample& s) { s.linear[0] = INT32_MAX - 512, s.linear[8] = INT32_MAX - 256; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.linear[0] = INT32_MAX - 511, s.linear[8] = INT32_MAX - 255; }), kTable);
  const auto with_end = [](std::int32_t length, std::uint32_t reciprocal) {
    return after([=](Sample& s) {
      s.cubic[0] = INT32_MAX - 511, s.cubic[8] = INT32_MAX - 255;
      s.cubic[9] = length, s.cubic[10] = static_cast<std::int32_t>(reciprocal);
    });
  };
  EXPECT_EQ(with_end(255, 2155905153U), kNone) << "its end is the last count";
  EXPECT_EQ(with_end(256, std::uint32_t{1} << 31), kTable) << "its end is beyond the last count";
  EXPECT_EQ(after([](Sample& s) { s.linear[2] = 0; }), kTable) << "the far end is never reached";
  EXPECT_EQ(after([](Sample& s) {
              // A length of 3: reach - one must be below the length and below 2^shift.
              s.cubic[1] = 3, s.cubic[2] = 715827883, s.cubic[3] = 1, s.cubic[8] = 3;
            }),
            kNone);
  EXPECT_EQ(after([](Sample& s) { s.cubic[1] = 3, s.cubic[2] = 715827884, s.cubic[3] = 1, s.cubic[8] = 3; }),
            kTable)
      << "one more: beyond the length";
  EXPECT_EQ(after([](Sample& s) { s.cubic[1] = 3, s.cubic[2] = 357913942, s.cubic[3] = 0, s.cubic[8] = 3; }),
            kTable)
      << "beyond one, though within the length";
  EXPECT_EQ(after([](Sample& s) { s.tables[0].grid_shift = 40; }), kTable) << "finds the first piece only";
  EXPECT_EQ(after([](Sample& s) { s.tables[0].grid_shift = 38; }), kTable) << "finds the second too early";
  EXPECT_EQ(after([](Sample& s) { s.tables[0].grid_multiplier = 1832519379; }), kTable)
      << "the second piece is found 44 counts late: its end is right, its start is not";
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].reciprocal = 0; }), kWrap);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0] = {0, 1, 1 << 30, 30}; }), kNone) << "the shortest period";
  EXPECT_EQ(after([](Sample& s) { s.wraps[0] = {0, 1 << 10, 1, 10}; }), kNone) << "the smallest reciprocal";
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].shift = kMaxShift + 1; }), kWrap);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0] = {INT32_MIN, INT32_MAX, INT32_MAX, kMaxShift + 1}; }), kWrap);
  EXPECT_EQ(after([](Sample& s) {
              s.wraps[0] = {0, INT32_MAX, 1 << 30, kMaxShift};
            }),
            kNone)
      << "the longest period needs the largest shift";
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].first = INT32_MAX - 1023; }), kNone);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].first = INT32_MAX - 1022; }), kWrap);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].reciprocal = (1 << 30) + 256; }), kNone)
      << "a period over 2^32 counts";
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].reciprocal = (1 << 30) + 257; }), kWrap);
  EXPECT_EQ(after([](Sample& s) { s.linear[4] = INT32_MIN, s.linear[5] = -1; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.cubic[7] = INT32_MAX, s.cubic[6] = 1; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.cubic[5] = INT32_MAX, s.cubic[6] = 1; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.cubic[4] = INT32_MAX, s.cubic[5] = 2; }), ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) {
              s.steps[5] = {OpCode::kLag, 40, 9, 0, 0, 1 << 30, 0};
              s.steps[4] = {OpCode::kLag, 40, 6, 0, 0, 1 << 30, 0};
            }),
            ProgramFault::kLag)
      << "a state used twice";
}

// Piece lengths of one count: nothing is inside of them.
TEST(GridFindsEveryPiece, AlsoOfOneCount) {
  const std::int32_t records[] = {0, 1, 1 << 30, 0, 1, 1, 1, 1, 1 << 30, 0, 2, 1};
  EXPECT_TRUE(grid_finds_every_piece({records, 2, 1, 1, 1, 0}));
  EXPECT_FALSE(grid_finds_every_piece({records, 2, 1, 1, 1, 64}));
  EXPECT_TRUE(grid_finds_every_piece({records, 1, 1, 1, 1, 63})) << "the largest shift: the only piece";
  EXPECT_FALSE(grid_finds_every_piece({records, 2, 1, 1, 1, 1}));
  const std::int32_t long_then_short[] = {0, 2, 1 << 30, 1, 1, 1, 2, 1, 1 << 30, 0, 2, 1};
  EXPECT_TRUE(grid_finds_every_piece({long_then_short, 2, 1, 1, 1, 1}));
}

TEST(WorkOf, CountsWhatATickDoes) {
  Sample s;
  const Equation e{{s.constants, 2}, 1, {s.steps, 6}, {s.terms, 3}, {s.tables, 2}, {s.wraps, 1}, 1, 8};
  // Six instructions, one channel, one lag; a grid and two linear columns, two steps of a search (of two
  // pieces: one) and a cubic column, a sine, three terms, a lag.
  EXPECT_EQ(work_of(e, 1), 6 * 4 + 6 + 1 + (10 + 2 * 2) + (10 + 4 + 6) + 30 + 3 + 8);
  // Records of 32 bytes, at most two lines each; two pieces are 64 bytes: no step is further apart than a
  // line.
  EXPECT_EQ(lines_of(e), 2u + 2u);
  Instruction lost = s.steps[1];
  lost.b = 2;
  const Equation none{{s.constants, 2}, 1, {&lost, 1}, {}, {s.tables, 2}, {}, 0, 1};
  EXPECT_EQ(lines_of(none), 0u);
  EXPECT_EQ(work_of(none, 0), 4u);
  std::int32_t many[8 * 16] = {};
  const ErrorTable search{many, 8, 3,
                          3,    0, 0};  // records of 64 bytes: 8, 4, 2 pieces are further than a line
  const Instruction find{OpCode::kLookUp, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(lines_of({{}, 0, {&find, 1}, {}, {&search, 1}, {}, 0, 3}), 2u + 3u);
  // A record of 80 bytes begins anywhere in a line: three lines. No step of a search comes to a single piece.
  std::int32_t wider[8 * 20] = {};
  const ErrorTable wide{wider, 8, 4, 3, 0, 0};
  EXPECT_EQ(lines_of({{}, 0, {&find, 1}, {}, {&wide, 1}, {}, 0, 4}), 3u + 3u);
}

}  // namespace
}  // namespace vernier::verify_test
