// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/verify.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace vernier::verify_test
