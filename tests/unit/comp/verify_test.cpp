#include "comp/verify.h"

#include <gtest/gtest.h>

namespace vernier {
namespace {

/// Two constants, one channel, a table of two segments with a linear and a cubic column, a wrap and a lag.
struct Sample {
  std::int32_t constants[2] = {1 << 20, -5};
  Channel channels[1] = {{ChannelKind::kPosition, 0, 0, 0, 1, -1000, 1000, 0}};
  Segment segments[2] = {{0, 1u << 8, 1u << 30, 8}, {1 << 8, 1u << 8, 1u << 30, 8}};
  View<Segment> tables[1] = {{segments, 2}};
  std::int32_t values[3] = {5, 6, -7}, cubic[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  View<std::int32_t> columns[2] = {{values, 3}, {cubic, 8}};
  Wrap wraps[1] = {{0, 1 << 10, 1 << 30, 40}};
  Instruction steps[7] = {
      {OpCode::kWrap, 0, 2, 0, 0, 0, 0},          // 3
      {OpCode::kSegment, 0, 3, 0, 0, 0, 0},       // 4
      {OpCode::kFraction, 0, 3, 0, 4, 0, 0},      // 5
      {OpCode::kLinearColumn, 0, 5, 0, 4, 0, 0},  // 6
      {OpCode::kCubicColumn, 0, 5, 1, 4, 0, 0},   // 7
      {OpCode::kMultiply, 3, 6, 0, 0, 0, 0},      // 8
      {OpCode::kLag, 40, 8, 0, 0, 1 << 30, 0},    // 9
  };
  Output outputs[1] = {{0, 9, 0, 1, 100, 100}};
  ValueRange ranges[kMaxRegisters] = {};

  ProgramFault verify() {
    Program p;
    p.equation = {{constants, 2}, 1, {steps, 7}, {tables, 1}, {columns, 2}, {wraps, 1}, 1};
    p.channels = {channels, 1};
    p.outputs = {outputs, 1};
    p.axis_count = 1;
    return verify_program(p, ranges);
  }
};

TEST(VerifyProgram, AcceptsASoundProgramAndKnowsItsRanges) {
  Sample s;
  ASSERT_EQ(s.verify(), ProgramFault::kNone);
  EXPECT_EQ(s.ranges[4].low, 0);
  EXPECT_EQ(s.ranges[4].high, 1);
  EXPECT_EQ(s.ranges[6].low, -7);
  EXPECT_EQ(s.ranges[6].high, 6);
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
  EXPECT_EQ(after([](Sample& s) { s.segments[0].length = 0; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.segments[1].start += 1; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.segments[0].reciprocal += 1; }), ProgramFault::kTable);
  EXPECT_EQ(after([](Sample& s) { s.columns[0].size = 0; }), ProgramFault::kColumn);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].period = 0; }), ProgramFault::kWrap);
  EXPECT_EQ(after([](Sample& s) { s.wraps[0].reciprocal /= 2; }), ProgramFault::kWrap);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].op = static_cast<OpCode>(200); }), ProgramFault::kOpCode);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].a = 3; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[0].b = 1; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[2].c = 900; }), ProgramFault::kOperand);
  EXPECT_EQ(after([](Sample& s) { s.steps[5].shift = 62; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[6].shift = 30; }), ProgramFault::kShift);
  EXPECT_EQ(after([](Sample& s) { s.steps[5] = {OpCode::kMultiply, 0, 0, 0, 0, 0, 0}; }),
            ProgramFault::kOverflow);
  EXPECT_EQ(after([](Sample& s) { s.steps[3].c = 2; }), ProgramFault::kSegmentRange);
  EXPECT_EQ(after([](Sample& s) { s.columns[0].size = 2; }), ProgramFault::kSegmentRange);
  EXPECT_EQ(after([](Sample& s) { s.columns[1].size = 7; }), ProgramFault::kSegmentRange);
  EXPECT_EQ(after([](Sample& s) { s.steps[6].b = 1; }), ProgramFault::kLag);
  EXPECT_EQ(after([](Sample& s) {
              s.steps[5] = s.steps[6];
              s.steps[5].a = 6;
            }),
            ProgramFault::kLag);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].source = 10; }), ProgramFault::kOutput);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].axis = 1; }), ProgramFault::kOutput);
  EXPECT_EQ(after([](Sample& s) { s.outputs[0].slew = -1; }), ProgramFault::kOutput);
}

}  // namespace
}  // namespace vernier
