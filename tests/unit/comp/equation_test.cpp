// SPDX-License-Identifier: GPL-3.0-or-later
// Each operation at its limits, against values that were computed by hand or with exact integers here.
#include "comp/equation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "comp/dense.h"
#include "comp/sine.h"

namespace vernier::equation_test {
namespace {

constexpr std::int32_t kLow = INT32_MIN, kHigh = INT32_MAX;

/// One instruction on constants; its results. Registers: 0, 1, 2 … are the constants.
struct SingleStep {
  std::array<std::int32_t, 4> constants{};
  std::array<ProductTerm, 4> terms{};
  ErrorTable table{};
  Wrap wrap{};
  LagState lag{};

  std::array<std::int32_t, 2> of(const Instruction& step, bool starting = false) {
    std::array<std::int32_t, 8> registers{};
    std::copy(constants.begin(), constants.end(), registers.begin());
    const Equation equation{{constants.data(), 4}, 0,          {&step, 1}, {terms.data(), 4},
                            {&table, 1},           {&wrap, 1}, 1,          2};
    LagState dense_lag = lag;
    run_equation(equation, registers.data(), &lag, starting);
    const std::array<std::int32_t, 2> results = {registers[4], registers[5]};
    EXPECT_EQ(dense(equation, dense_lag, starting), results);
    EXPECT_EQ(dense_lag.value, lag.value);
    return results;
  }

  /// The same in the dense form, for values that the verifier accepts.
  static std::array<std::int32_t, 2> dense(const Equation& equation, LagState& lag, bool starting) {
    std::vector<DenseCell> cells(dense_size(equation));
    DenseFrame frame;
    EXPECT_TRUE(make_dense(equation, {cells.data(), static_cast<std::uint32_t>(cells.size()), &frame}));
    frame.lags = &lag;
    frame.starting = starting;
    run_dense({cells.data(), static_cast<std::uint32_t>(cells.size()), &frame});
    return {static_cast<std::int32_t>(frame.registers[4]), static_cast<std::int32_t>(frame.registers[5])};
  }
};

std::int32_t result(std::int32_t a, std::int32_t b, const Instruction& step) {
  SingleStep run;
  run.constants = {a, b, 0, 0};
  return run.of(step)[0];
}
Instruction step_of(OpCode op, unsigned shift = 0, std::int32_t k = 0, std::int32_t l = 0) {
  return {op, static_cast<std::uint8_t>(shift), 0, 1, 0, k, l};
}

TEST(RunEquation, LinearIsRoundedOnceWithTiesUp) {
  EXPECT_EQ(result(7, -3, step_of(OpCode::kLinear, 0, 2, 5)), -1);
  EXPECT_EQ(result(1, 1, step_of(OpCode::kLinear, 2, 1, 1)), 1);                            // 0.5
  EXPECT_EQ(result(-1, -1, step_of(OpCode::kLinear, 2, 1, 1)), 0);                          // -0.5
  EXPECT_EQ(result(-3, 0, step_of(OpCode::kLinear, 1, 1, 0)), -1);                          // -1.5
  EXPECT_EQ(result(kHigh, kLow, step_of(OpCode::kLinear, 31, kMaxFactor, kMaxFactor)), 0);  // -0.5 of an LSB
  EXPECT_EQ(result(kLow, 0, step_of(OpCode::kLinear, 30, kMaxFactor, 0)), kLow);
  EXPECT_EQ(result(kHigh, 0, step_of(OpCode::kLinear, 30, -kMaxFactor, 0)), -kHigh);
}

TEST(RunEquation, ProductHasAllBitsBeforeItsShift) {
  EXPECT_EQ(result(3, -5, step_of(OpCode::kMultiply)), -15);
  EXPECT_EQ(result(kLow, kLow, step_of(OpCode::kMultiply, 61)), 2);
  EXPECT_EQ(result(kHigh, kHigh, step_of(OpCode::kMultiply, 31)), kHigh - 1);
  EXPECT_EQ(result(1 << 16, 1 << 15, step_of(OpCode::kMultiply, 1)), 1 << 30);
}

TEST(RunEquation, SumOfProductsAddsThenSubtracts) {
  SingleStep run;
  run.constants = {1000, -7, 3, kHigh};
  run.terms = {{{0, 1, 0}, {0, 2, 1}, {1, 2, 0}, {3, 3, 62}}};
  // (10 << 4) + 1000 * -7 + (1000 * 3 >> 1) - (-7 * 3) - (kHigh^2 >> 62), over 2^2
  Instruction step{OpCode::kDot, 2, 2, 2, 4, 10, 0};
  EXPECT_EQ(run.of(step)[0], (160 - 7000 + 1500 + 21 - 0 + 2) >> 2);
  step = {OpCode::kDot, 0, 0, 1, 0, 5, 2};
  EXPECT_EQ(run.of(step)[0], 26);
  step = {OpCode::kDot, 31, 1, 0, 31, 1, 0};
  EXPECT_EQ(run.of(step)[0], 1);  // 2^31 - 7000, over 2^31, rounded
  step = {OpCode::kDot, 1, 1, 0, 0, 0, 1};
  EXPECT_EQ(run.of(step)[0], 750);
  run.terms[0] = {1, 2, 1};  // -21 >> 1 is -11: truncated towards minus infinity
  step = {OpCode::kDot, 0, 1, 0, 0, 0, 0};
  EXPECT_EQ(run.of(step)[0], -11);
}

TEST(RunEquation, ComparesAtTheEndsOfTheRange) {
  EXPECT_EQ(result(-kHigh, 0, step_of(OpCode::kAbs)), kHigh);
  EXPECT_EQ(result(kHigh, 0, step_of(OpCode::kAbs)), kHigh);
  EXPECT_EQ(result(0, 1, step_of(OpCode::kAbs)), 0);
  EXPECT_EQ(result(kLow, kHigh, step_of(OpCode::kMin)), kLow);
  EXPECT_EQ(result(kHigh, kLow, step_of(OpCode::kMin)), kLow);
  EXPECT_EQ(result(kLow, kHigh, step_of(OpCode::kMax)), kHigh);
  EXPECT_EQ(result(kHigh, kLow, step_of(OpCode::kMax)), kHigh);
  EXPECT_EQ(result(kLow, 0, step_of(OpCode::kSign)), -1);
  EXPECT_EQ(result(0, 5, step_of(OpCode::kSign)), 0);
  EXPECT_EQ(result(1, 0, step_of(OpCode::kSign)), 1);
  EXPECT_EQ(result(kLow, kLow, step_of(OpCode::kEqual)), 1);
  EXPECT_EQ(result(kLow, kHigh, step_of(OpCode::kEqual)), 0);
  EXPECT_EQ(result(kLow, kHigh, step_of(OpCode::kLess)), 1);
  EXPECT_EQ(result(4, 4, step_of(OpCode::kLess)), 0);
  EXPECT_EQ(result(5, 4, step_of(OpCode::kLess)), 0);
}

TEST(RunEquation, PositionComesIntoItsPeriod) {
  SingleStep run;
  run.wrap = {-512, 1 << 10, 1 << 30, 40};
  const auto wrapped = [&](std::int32_t position) {
    run.constants = {position, 0, 0, 0};
    return run.of({OpCode::kWrap, 0, 0, 0, 0, 0, 0})[0];
  };
  EXPECT_EQ(wrapped(-512), -512);
  EXPECT_EQ(wrapped(511), 511);
  EXPECT_EQ(wrapped(512), -512);
  EXPECT_EQ(wrapped(-513), 511);
  EXPECT_EQ(wrapped(kLow), kLow & 1023);  // 2^31 is a multiple of the period
  EXPECT_EQ(wrapped(kHigh), -1);
}

TEST(RunEquation, LookUpHasOneResultForEachColumn) {
  const std::int32_t records[] = {0, 256, kLow, 9, 10, 20, -4, -6, 256, 256, kLow, 9, 30, 0, -10, 2};
  SingleStep run;
  run.table = {records, 2, 2, 1, 0, 0};
  const auto at = [&](std::int32_t position) {
    run.constants = {position, 0, 0, 0};
    return run.of({OpCode::kLookUp, 0, 0, 0, 0, 0, 0});
  };
  EXPECT_EQ(at(0), (std::array<std::int32_t, 2>{10, -4}));
  EXPECT_EQ(at(128), (std::array<std::int32_t, 2>{20, -7}));
  EXPECT_EQ(at(256), (std::array<std::int32_t, 2>{30, -10}));
  EXPECT_EQ(at(kHigh), (std::array<std::int32_t, 2>{30, -8})) << "beyond the last station its value";
  EXPECT_EQ(at(kLow), (std::array<std::int32_t, 2>{10, -4})) << "before the first station its value";
}

TEST(RunEquation, SineAndCosineAreTwoResults) {
  SingleStep run;
  run.constants = {1 << 30, 0, 0, 0};  // a quarter turn
  const auto quarter = run.of({OpCode::kSineCosine, 30, 0, 0, 0, 1 << 30, 0});
  EXPECT_EQ(quarter[0], sine_cosine(1u << 30).sine);
  EXPECT_NEAR(quarter[0], 1 << 30, 2);
  EXPECT_NEAR(quarter[1], 0, 2);
  run.constants = {1 << 29, 0, 0, 0};  // an eighth
  EXPECT_NEAR(run.of({OpCode::kSineCosine, 30, 0, 0, 0, 1 << 30, 0})[0], 759250125, 2);
  EXPECT_NEAR(run.of({OpCode::kSineCosine, 30, 0, 0, 0, 1 << 30, 0})[1], 759250125, 2);
  run.constants = {-(1 << 30), 0, 0, 0};
  EXPECT_NEAR(run.of({OpCode::kSineCosine, 30, 0, 0, 0, 1 << 30, 0})[0], -(1 << 30), 2);
}

TEST(RunEquation, LagStartsAtItsInputAndFollowsByItsGain) {
  SingleStep run;
  run.constants = {1000, 0, 0, 0};
  const Instruction half{OpCode::kLag, 31, 0, 0, 0, 1 << 30, 0};  // gain 1/2
  EXPECT_EQ(run.of(half, true)[0], 1000);
  run.constants[0] = 0;
  EXPECT_EQ(run.of(half)[0], 500);
  EXPECT_EQ(run.of(half)[0], 250);
  run.constants[0] = kLow;
  EXPECT_EQ(run.of(half, true)[0], kLow);
  run.constants[0] = kHigh;
  EXPECT_EQ(run.of(half)[0], 0) << "half way over the whole range, -0.5 rounded up";
}

TEST(RunEquation, ResultsFollowEachOther) {
  const std::int32_t constants[] = {3, 4};
  const Instruction steps[] = {{OpCode::kMultiply, 0, 0, 1, 0, 0, 0}, {OpCode::kLinear, 0, 2, 0, 0, 2, 1}};
  std::int32_t registers[4] = {3, 4, 0, 0};
  run_equation({{constants, 2}, 0, {steps, 2}, {}, {}, {}, 0, 2}, registers, nullptr, false);
  EXPECT_EQ(registers[2], 12);
  EXPECT_EQ(registers[3], 27);
}

TEST(ResultsOf, AreThoseOfTheTable) {
  const ErrorTable table{nullptr, 1, 6, 1, 0, 0};
  EXPECT_EQ(results_of({OpCode::kLookUp, 0, 0, 0, 0, 0, 0}, {&table, 1}), 6u);
  EXPECT_EQ(results_of({OpCode::kLookUp, 0, 0, 1, 0, 0, 0}, {&table, 1}), 0u);
  EXPECT_EQ(results_of({OpCode::kSineCosine, 0, 0, 0, 0, 1, 0}, {&table, 1}), 2u);
  EXPECT_EQ(results_of({OpCode::kAbs, 0, 0, 0, 0, 0, 0}, {&table, 1}), 1u);
}

}  // namespace
}  // namespace vernier::equation_test
