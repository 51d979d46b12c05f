// SPDX-License-Identifier: GPL-3.0-or-later
// The dense form against the interpreted program, bit for bit, at every size at which its code changes.
#include "comp/dense.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <iterator>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "comp/compensator.h"
#include "comp/verify.h"

namespace vernier::dense_test {
namespace {

constexpr std::int32_t kLow = INT32_MIN, kHigh = INT32_MAX;
constexpr std::uint32_t kConstants = 4, kChannels = 4;

/// A program over four constants and four channels.
struct Sample {
  std::vector<std::int32_t> constants = {3, -70000, kLow, kHigh};
  std::vector<std::int32_t> channels = {5, -1234567, kLow, kHigh};
  std::vector<Instruction> steps;
  std::vector<ProductTerm> terms;
  std::vector<ErrorTable> tables;
  std::vector<Wrap> wraps;

  Equation equation() const {
    Equation e;
    e.constants = {constants.data(), kConstants};
    e.channel_count = kChannels;
    e.instructions = {steps.data(), static_cast<std::uint32_t>(steps.size())};
    e.terms = {terms.data(), static_cast<std::uint32_t>(terms.size())};
    e.tables = {tables.data(), static_cast<std::uint32_t>(tables.size())};
    e.wraps = {wraps.data(), static_cast<std::uint32_t>(wraps.size())};
    for (const Instruction& step : steps) e.result_count += results_of(step, e.tables);
    return e;
  }
  std::vector<std::int32_t> interpreted() const {
    std::vector<std::int32_t> registers(constants);
    registers.insert(registers.end(), channels.begin(), channels.end());
    registers.resize(equation().register_count());
    run_equation(equation(), registers.data(), nullptr, false);
    return registers;
  }
  std::vector<std::int32_t> dense() const {
    std::vector<DenseCell> cells(dense_size(equation()));
    const auto frame = std::make_unique<DenseFrame>();
    const DenseMemory memory{cells.data(), static_cast<std::uint32_t>(cells.size()), frame.get()};
    EXPECT_TRUE(make_dense(equation(), memory));
    for (std::uint32_t i = 0; i < kChannels; ++i) frame->registers[kConstants + i] = channels[i];
    run_dense(memory);
    std::vector<std::int32_t> registers;
    for (std::uint32_t i = 0; i < equation().register_count(); ++i)
      registers.push_back(static_cast<std::int32_t>(frame->registers[i]));
    return registers;
  }
};

/// A sum with `counts[k]` products of kind k: constant factor, two registers added, subtracted, and both with
/// a shift. The constant factors are subtracted in turn.
struct Sum {
  std::vector<ProductTerm> plus, minus;

  explicit Sum(const std::vector<std::uint32_t>& counts) {
    std::uint16_t n = 0;
    const auto channel = [&n] { return static_cast<std::uint16_t>(kConstants + n++ % 2); };
    for (std::uint32_t i = 0; i < counts[0]; ++i) {
      const auto constant = static_cast<std::uint16_t>(i % 2);
      ProductTerm term{constant, channel(), 0};
      if (i % 3 == 1) std::swap(term.a, term.b);
      (i % 2 == 0 ? plus : minus).push_back(term);
    }
    for (std::uint32_t i = 0; i < counts[1]; ++i) plus.push_back({channel(), channel(), 0});
    for (std::uint32_t i = 0; i < counts[2]; ++i) minus.push_back({channel(), channel(), 0});
    const auto shift = [&n] { return static_cast<std::uint16_t>(1 + n % 3); };
    for (std::uint32_t i = 0; i < counts[3]; ++i) plus.push_back({channel(), channel(), shift()});
    for (std::uint32_t i = 0; i < counts[4]; ++i) minus.push_back({1, channel(), shift()});
  }
  void add_to(Sample& sample) const {
    const auto from = static_cast<std::int32_t>(sample.terms.size());
    for (const std::vector<ProductTerm>& part : {plus, minus})
      sample.terms.insert(sample.terms.end(), part.begin(), part.end());
    sample.steps.push_back({OpCode::kDot, 16, static_cast<std::uint16_t>(plus.size()),
                            static_cast<std::uint16_t>(minus.size()), 3, -7, from});
  }
};

TEST(Dense, SumsOfEveryKindAndNumberOfProductsAreThoseOfTheProgram) {
  // Up to three products in every combination; then one kind at the largest number of a step and one beyond.
  for (std::uint32_t code = 1; code < 4 * 4 * 4 * 4 * 4; ++code) {
    std::vector<std::uint32_t> counts;
    std::uint32_t all = 0;
    for (std::uint32_t k = 0, rest = code; k < 5; ++k, rest /= 4) all += counts.emplace_back(rest % 4);
    Sample sample;
    Sum(counts).add_to(sample);
    ASSERT_EQ(sample.dense(), sample.interpreted()) << "products " << all << " code " << code;
  }
  for (std::size_t kind = 0; kind < 5; ++kind)
    for (std::uint32_t count = 1; count <= 18; ++count) {
      Sample sample;
      std::vector<std::uint32_t> counts(5, 0);
      counts[kind] = count;
      Sum(counts).add_to(sample);
      counts[(kind + 1) % 5] = 5;
      Sum(counts).add_to(sample);
      ASSERT_EQ(sample.dense(), sample.interpreted()) << "kind " << kind << " count " << count;
    }
}

TEST(Dense, SubtractsAProductWithTheLowestConstant) {
  Sample sample;
  sample.terms = {{2, 4, 0}, {5, 2, 0}, {3, 6, 0}, {2, 7, 0}};  // kLow * 5, -1234567 * kLow, kHigh * kLow
  for (std::uint16_t minus = 0; minus < 2; ++minus)
    for (std::int32_t term = 0; term < 4; ++term)
      sample.steps.push_back({OpCode::kDot, 31, static_cast<std::uint16_t>(1 - minus), minus, 0, 0, term});
  EXPECT_EQ(sample.dense(), sample.interpreted());
  EXPECT_EQ(sample.dense()[kConstants + kChannels + 4], 5);  // -(-2^31 * 5) / 2^31
}

TEST(Dense, ProductsAndWeightedSumsAreThoseOfTheProgram) {
  Sample sample;
  for (const std::uint16_t a : std::initializer_list<std::uint16_t>{0, 2, 3, 4, 6, 7})
    for (const std::uint16_t b : std::initializer_list<std::uint16_t>{0, 2, 3, 4, 6, 7}) {
      sample.steps.push_back({OpCode::kMultiply, 33, a, b, 0, 0, 0});
      sample.steps.push_back({OpCode::kLinear, 31, a, b, 0, kMaxFactor, -kMaxFactor});
      sample.steps.push_back({OpCode::kLinear, 30, a, b, 0, kMaxFactor, 0});
    }
  EXPECT_EQ(sample.dense(), sample.interpreted());
}

TEST(Dense, LimitsByConstantsGiveBothResults) {
  constexpr std::uint16_t kFirst = kConstants + kChannels;
  const auto of = [](OpCode op, std::uint16_t a, std::uint16_t b) {
    return Instruction{op, 0, a, b, 0, 1, 0};
  };
  const OpCode max = OpCode::kMax, min = OpCode::kMin;
  const std::vector<std::vector<Instruction>> programs = {
      {of(max, 4, 1), of(min, kFirst, 0)},                                      // of a channel, at the start
      {of(OpCode::kLinear, 4, 0), of(max, kFirst, 1), of(min, kFirst + 1, 0)},  // of the sum before
      {of(OpCode::kLinear, 4, 0), of(max, 5, 1), of(min, kFirst + 1, 0)},       // of another register
      {of(OpCode::kMultiply, 4, 0), of(max, kFirst, 1), of(min, kFirst + 1, 0)},
      {{OpCode::kDot, 0, 1, 0, 0, 0, 0}, of(max, kFirst, 1), of(min, kFirst + 1, 0)},
      {of(OpCode::kAbs, 4, 0), of(max, kFirst, 1), of(min, kFirst + 1, 0)},  // of no sum
      {of(max, 4, 5), of(min, kFirst, 0)},                                   // by a register
      {of(max, 4, 1), of(min, kFirst, 5)},
      {of(max, 4, 1), of(min, 5, 0)},  // of another value
      {of(max, 4, 1), of(max, kFirst, 0)},
      {of(min, 4, 1), of(min, kFirst, 0)},
      {of(max, 4, 1)}};
  for (const std::vector<Instruction>& steps : programs)
    for (const std::int32_t value : {-kHigh, -70001, -70000, -69999, 2, 3, 4, kHigh}) {
      Sample sample;
      sample.terms = {{4, 0, 0}};
      sample.steps = steps;
      sample.channels[0] = value / (steps[0].op == OpCode::kMultiply || steps[0].op == OpCode::kDot ? 3 : 1);
      ASSERT_EQ(sample.dense(), sample.interpreted()) << value;
    }
}

/// A table of three segments of 1000 counts, and its grid.
struct Table {
  std::vector<std::int32_t> records;
  ErrorTable table;

  Table(std::uint16_t columns, std::uint16_t degree, bool grid) {
    std::mt19937 random(11);
    for (std::int32_t i = 0; i < 3; ++i) {
      const auto reciprocal = static_cast<std::uint32_t>(((std::uint64_t{1} << 39) + 999) / 1000);
      for (const std::int32_t word : {i * 1000 - 500, 1000, static_cast<std::int32_t>(reciprocal), 9})
        records.push_back(word);
      for (std::int32_t c = 0; c < columns * (degree + 1); ++c)
        records.push_back(static_cast<std::int32_t>(random() % 1000000001u) - 500000000);
    }
    table = {records.data(), 3, columns, degree, 0, 0};
    if (grid) table.grid_multiplier = static_cast<std::uint32_t>((std::uint64_t{1} << 40) / 1000);
    if (grid) table.grid_shift = 40;
  }
};

TEST(Dense, TablesGiveTheValuesOfTheProgramAtAndBeyondTheirEnds) {
  for (const std::uint16_t columns : std::initializer_list<std::uint16_t>{1, 2, 5, 6, 7})
    for (const std::uint16_t degree : std::initializer_list<std::uint16_t>{1, 3})
      for (const bool grid : {false, true}) {
        const Table table(columns, degree, grid);
        ASSERT_TRUE(!grid || grid_finds_every_piece(table.table));
        Sample sample;
        sample.tables = {table.table};
        sample.steps = {{OpCode::kLookUp, 0, 4, 0, 0, 0, 0}};
        for (const std::int32_t position :
             {kLow, -501, -500, -499, 0, 499, 500, 501, 2499, 2500, 2501, kHigh}) {
          sample.channels[0] = position;
          ASSERT_EQ(sample.dense(), sample.interpreted()) << columns << " columns at " << position;
        }
      }
}

TEST(Dense, ThreeTablesInSuccessionGiveTheValuesOfTheProgram) {
  const Table even(6, 1, true), other(6, 1, true), searched(6, 1, false), cubic(6, 3, true),
      narrow(5, 1, true);
  constexpr std::uint16_t kFirst = kConstants + kChannels;
  Sample sample;
  sample.tables = {even.table, other.table, searched.table, cubic.table, narrow.table};
  const auto look_up = [](std::uint16_t position, std::uint16_t table) {
    return Instruction{OpCode::kLookUp, 0, position, table, 0, 0, 0};
  };
  const std::vector<std::vector<Instruction>> programs = {
      {look_up(4, 0), look_up(5, 1), look_up(6, 0)},
      {look_up(4, 0), look_up(5, 1), look_up(6, 0), look_up(7, 1)},
      {look_up(4, 0), look_up(5, 1)},  // two only
      {look_up(4, 0), {OpCode::kAbs, 0, 0, 0, 0, 0, 0}, look_up(5, 1), look_up(6, 0)},
      {look_up(4, 0), look_up(kFirst, 1), look_up(5, 0)},  // the position is a result
      {look_up(4, 0), look_up(5, 1), look_up(kFirst + 11, 0)},
      {look_up(4, 0), look_up(5, 2), look_up(6, 0)},
      {look_up(4, 0), look_up(5, 1), look_up(6, 3)},
      {look_up(4, 4), look_up(5, 1), look_up(6, 0)}};
  const std::int32_t positions[] = {kLow, -501, -500, -499, 0, 499, 500, 501, 2499, 2500, 2501, kHigh};
  for (const std::vector<Instruction>& steps : programs)
    for (std::size_t i = 0; i < std::size(positions); ++i) {
      sample.steps = steps;
      for (std::size_t k = 0; k < kChannels; ++k)
        sample.channels[k] = positions[(i + 5 * k) % std::size(positions)];
      ASSERT_EQ(sample.dense(), sample.interpreted()) << "at " << positions[i];
    }
}

// The memory of a program depends on it: a step has three cells and one for each product, and takes at most
// eight products with a constant factor, or four others. Where there are no jumps, and on a small target, it
// takes half.
TEST(Dense, LongSumHasAsFewStepsAsItsProductsNeed) {
  const auto size_of = [](std::size_t kind, std::uint32_t count) {
    std::vector<std::uint32_t> counts(5, 0);
    counts[kind] = count;
    Sample sample;
    Sum(counts).add_to(sample);
    return dense_size(sample.equation());
  };
  const bool small = size_of(0, 5) != 3 + 5 + 1;
  for (std::size_t kind = 0; kind < 5; ++kind) {
    const std::uint32_t most = (kind == 0 ? 8 : 4) / (small ? 2 : 1);
    for (std::uint32_t count = 1; count <= 2 * 8 + 1; ++count)
      EXPECT_EQ(size_of(kind, count), count + 3 * ((count + most - 1) / most) + 1) << kind << " " << count;
  }
}

TEST(Dense, MemoryWithOneCellTooFewStaysAsItWas) {
  Sample sample;
  Sum({2, 1, 0, 1, 0}).add_to(sample);
  const std::uint32_t size = dense_size(sample.equation());
  EXPECT_EQ(size, 3 + 2 + 3 + 1 + 3 + 1 + 1u) << "three kinds, four products, the end";
  std::vector<DenseCell> cells(size);
  DenseFrame frame;
  EXPECT_FALSE(make_dense(sample.equation(), {cells.data(), size - 1, &frame}));
  for (const DenseCell& cell : cells) EXPECT_EQ(cell.start, 0);
  EXPECT_EQ(frame.registers[0], 0);
  EXPECT_TRUE(make_dense(sample.equation(), {cells.data(), size, &frame}));
  EXPECT_EQ(frame.registers[2], kLow);
}

TEST(Dense, CompensatorGivesTheSameCorrectionsInBothForms) {
  const Channel channel{ChannelKind::kPosition, 0, 0, 0, 1, -1000000, 1000000, 0};
  const std::int32_t constants[] = {77};
  const Instruction steps[] = {{OpCode::kLag, 33, 1, 0, 0, 1 << 30, 0},
                               {OpCode::kMultiply, 4, 2, 0, 0, 0, 0}};
  const Output output{0, 3, 0, 1, INT32_MAX, INT32_MAX};
  Program p;
  p.equation.constants = {constants, 1};
  p.equation.channel_count = 1;
  p.equation.instructions = {steps, 2};
  p.equation.lag_count = 1;
  p.equation.result_count = 2;
  p.channels = {&channel, 1};
  p.outputs = {&output, 1};
  p.axis_count = 1;
  std::vector<ValueRange> ranges(kMaxRegisters);
  ASSERT_EQ(verify_program(p, ranges.data()), ProgramFault::kNone);
  Compensator interpreted(p), dense(p);
  std::vector<DenseCell> cells(dense_size(p.equation));
  const auto size = static_cast<std::uint32_t>(cells.size());
  DenseFrame frame;
  EXPECT_FALSE(dense.use_dense({cells.data(), size - 1, &frame}));
  EXPECT_FALSE(dense.dense());
  EXPECT_TRUE(dense.use_dense({cells.data(), size, &frame}));
  EXPECT_TRUE(dense.dense());
  for (int i = 0; i < 20; ++i) {
    if (i == 10) interpreted.reset(), dense.reset();
    CycleInput input;
    input.axis[0].position = AxisPosition(i * 50021 - 400000);
    EXPECT_EQ(dense.step(input).correction[0].counts, interpreted.step(input).correction[0].counts) << i;
    EXPECT_EQ(dense.register_value(1), interpreted.register_value(1));
    EXPECT_EQ(dense.register_value(3), interpreted.register_value(3));
  }
}

}  // namespace
}  // namespace vernier::dense_test
