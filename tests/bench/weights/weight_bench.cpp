// SPDX-License-Identifier: GPL-3.0-or-later
// The work that the verifier counts for each operation (work_of, comp/verify.h) beside the time that it takes
// here. One is a product of a long sum, which a board's budget is measured with; an operation whose time is
// more of these than its weight is one that an image could be heavier with than the board believes.
//   weight_bench [REPEATS]     (default 200): the least of as many measurements counts
// Asserts no time: it fails where an operation is not counted at all.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "comp/verify.h"
#include "firmware/core/cycle/work_budget.h"
#include "hal/linux/monotonic_clock.h"

namespace vernier {
namespace {

constexpr std::uint32_t kSteps = 240, kRuns = 100;
constexpr std::int32_t kLength = 500'000;  // 4096 of them stay below 2^31, and 2^50 of one below 2^32

/// A table of even or uneven stations.
struct Columns {
  Columns(std::uint32_t pieces, std::uint16_t columns, std::uint16_t degree, bool even) {
    table.pieces = pieces;
    table.columns = columns;
    table.degree = degree;
    if (even) {
      table.grid_shift = 50;
      table.grid_multiplier =
          static_cast<std::uint32_t>(((std::uint64_t{1} << table.grid_shift) + kLength / 2) / kLength);
    }
    words.resize(std::size_t{pieces} * table.stride(), 7);
    for (std::uint32_t i = 0; i < pieces; ++i) {
      const Segment segment{static_cast<std::int32_t>(i) * kLength, kLength,
                            static_cast<std::uint32_t>(((std::uint64_t{1} << 50) + kLength - 1) / kLength),
                            20};
      std::memcpy(words.data() + std::size_t{i} * table.stride(), &segment, sizeof segment);
    }
    table.records = words.data();
  }
  Columns(const Columns& other) : table(other.table), words(other.words) { table.records = words.data(); }
  Columns& operator=(const Columns&) = delete;
  ErrorTable table;
  std::vector<std::int32_t> words;
};

/// One kind of operation, many times in a row.
struct Case {
  std::string name;
  Instruction step;
  std::uint32_t terms = 0;
  const Columns* columns = nullptr;
};

struct Run {
  Equation equation;
  std::vector<Instruction> steps;
  std::vector<ProductTerm> terms;
  std::vector<std::int32_t> registers;
  LagState lags[kMaxLags] = {};
  Wrap wrap{0, 1 << 20, 1 << 10, 30};

  explicit Run(const Case& one) {
    for (std::uint32_t i = 0; i < one.terms; ++i) terms.push_back({0, 1, 20});
    const std::uint32_t results = one.columns != nullptr ? one.columns->table.columns : 1;
    // No more results than a board has registers.
    const std::uint32_t count = std::min(kSteps, (kMaxRegisters - 2) / (2 * results));
    for (std::uint32_t i = 0; i < count; ++i) {
      steps.push_back(one.step);
      // Lags have states of their own, as many as a board has.
      if (one.step.op == OpCode::kLag) steps.back().b = static_cast<std::uint16_t>(i % kMaxLags);
    }
    equation.channel_count = 2;
    equation.instructions = {steps.data(), static_cast<std::uint32_t>(steps.size())};
    equation.terms = {terms.data(), static_cast<std::uint32_t>(terms.size())};
    if (one.columns != nullptr) equation.tables = {&one.columns->table, 1};
    equation.wraps = {&wrap, 1};
    for (const Instruction& step : steps) equation.result_count += results_of(step, equation.tables);
    registers.resize(equation.register_count());
    registers[0] = 3'456'789;
    registers[1] = 1'234'567;
  }

  double ns_of_one(int repeats) {
    double best = 1e99;
    for (int i = 0; i < repeats; ++i) {
      const auto begun = std::chrono::steady_clock::now();
      for (std::uint32_t run = 0; run < kRuns; ++run) {
        registers[0] ^= 1;
        run_equation(equation, registers.data(), lags, false);
      }
      const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begun;
      best = std::min(best, took.count() / kRuns / static_cast<double>(steps.size()));
    }
    return best;
  }
  /// Each in a tick that finds nothing of it in the caches, as one may that comes once a millisecond.
  double cold_ns_of_one(int repeats) {
    static std::vector<std::int32_t> other(std::size_t{16} << 20);
    double best = 1e99;
    for (int i = 0; i < repeats; ++i) {
      for (std::size_t k = 0; k < other.size(); k += 16) other[k] += 1;
      const auto begun = std::chrono::steady_clock::now();
      run_equation(equation, registers.data(), lags, false);
      const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begun;
      best = std::min(best, took.count() / static_cast<double>(steps.size()));
    }
    return best;
  }
  /// of_line: what a line of memory counts, beside the operations.
  double weight_of_one(std::uint64_t of_line = 0) const {
    Equation counted = equation;
    counted.lag_count = 0;
    return static_cast<double>(work_of(counted, 0) + of_line * lines_of(counted)) /
           static_cast<double>(steps.size());
  }
};

Instruction plain(OpCode op, std::int32_t k = 1 << 20, std::int32_t l = 1 << 20) {
  return {op, 20, 0, 1, 0, k, l};
}

/// Operations in an order that no processor foresees at first sight.
void mix(Run& run) {
  constexpr OpCode kMixed[] = {OpCode::kLinear, OpCode::kMultiply, OpCode::kAbs, OpCode::kMin,
                               OpCode::kSign,   OpCode::kLess,     OpCode::kMax, OpCode::kEqual};
  std::uint32_t random = 12345;
  for (Instruction& step : run.steps) {
    random = random * 1664525 + 1013904223;
    step.op = kMixed[random >> 29];
  }
}

/// As many look-ups as a board has tables, each in its own.
void spread(Run& run, const std::vector<Columns>& each, std::vector<ErrorTable>& tables) {
  for (const Columns& one : each) tables.push_back(one.table);
  run.steps.resize(tables.size());
  for (std::size_t i = 0; i < tables.size(); ++i) run.steps[i].b = static_cast<std::uint16_t>(i);
  run.equation.instructions = {run.steps.data(), static_cast<std::uint32_t>(run.steps.size())};
  run.equation.tables = {tables.data(), static_cast<std::uint32_t>(tables.size())};
  run.equation.result_count = static_cast<std::uint32_t>(tables.size());
}

int measure(int repeats) {
  MonotonicClock clock;
  const Columns line(64, 6, 1, true), cubic(64, 6, 3, true), uneven(64, 6, 1, false),
      long_one(4096, 1, 1, false), narrow(64, 1, 1, true);
  Instruction sum{OpCode::kDot, 4, 32, 32, 0, 1, 0}, short_sum{OpCode::kDot, 4, 2, 1, 0, 1, 0};
  Instruction look{OpCode::kLookUp, 0, 0, 0, 0, 0, 0};
  const std::vector<Case> cases = {{"sum of 64 products", sum, 64, nullptr},
                                   {"sum of 3 products", short_sum, 3, nullptr},
                                   {"linear", plain(OpCode::kLinear), 0, nullptr},
                                   {"product", plain(OpCode::kMultiply), 0, nullptr},
                                   {"absolute value", plain(OpCode::kAbs), 0, nullptr},
                                   {"lower", plain(OpCode::kMin), 0, nullptr},
                                   {"higher", plain(OpCode::kMax), 0, nullptr},
                                   {"sign", plain(OpCode::kSign), 0, nullptr},
                                   {"equal", plain(OpCode::kEqual), 0, nullptr},
                                   {"less", plain(OpCode::kLess), 0, nullptr},
                                   {"wrap", {OpCode::kWrap, 0, 0, 0, 0, 0, 0}, 0, nullptr},
                                   {"sine and cosine", plain(OpCode::kSineCosine), 0, nullptr},
                                   {"lag", {OpCode::kLag, 20, 0, 0, 0, 1 << 10, 0}, 0, nullptr},
                                   {"table, 1 column, even", look, 0, &narrow},
                                   {"table, 6 columns, even", look, 0, &line},
                                   {"table, 6 cubics, even", look, 0, &cubic},
                                   {"table, 6 columns, uneven", look, 0, &uneven},
                                   {"table, 4096 uneven pieces", look, 0, &long_one}};
  Run first(cases.front());
  const double one_ns = first.ns_of_one(repeats) / first.weight_of_one();
  std::printf("one is %.3f ns: a sixty-eighth of a sum of 64 products\n", one_ns);
  std::printf("%-28s%10s%10s%12s%10s\n", "operation", "ns", "weight", "costs", "ratio");
  bool counted = true;
  double worst = 0;
  for (const Case& one : cases) {
    Run run(one);
    const double ns = run.ns_of_one(repeats), weight = run.weight_of_one();
    std::printf("%-28s%10.2f%10.1f%12.1f%10.2f\n", one.name.c_str(), ns, weight, ns / one_ns,
                ns / one_ns / weight);
    counted = counted && weight >= 1;
    worst = std::max(worst, ns / one_ns / weight);
  }
  const auto print = [&](const char* name, const Run& run, double ns) {
    const double weight = run.weight_of_one();
    std::printf("%-28s%10.2f%10.1f%12.1f%10.2f\n", name, ns, weight, ns / one_ns, ns / one_ns / weight);
  };
  Run mixed(cases[2]);
  mix(mixed);
  const double mixed_ns = mixed.ns_of_one(repeats);
  print("mixed, plain ones", mixed, mixed_ns);
  worst = std::max(worst, mixed_ns / one_ns / mixed.weight_of_one());
  Run cold_sum(cases.front());
  print("cold: sum of 64 products", cold_sum, cold_sum.cold_ns_of_one(std::min(repeats, 20)));
  Run cold(cases.back());
  const std::vector<Columns> each(kMaxTables, Columns(2048, 1, 1, false));
  std::vector<ErrorTable> tables;
  spread(cold, each, tables);
  const double cold_ns = cold.cold_ns_of_one(std::min(repeats, 20));
  print("cold: table, 2048 pieces", cold, cold_ns);
  std::printf("an image is at most %.2f times as heavy as it is counted, where it is in the caches\n", worst);
  std::vector<std::uint32_t> memory(kWordsBeyondCaches);
  const std::uint64_t of_line = measured_work_budget(clock, TimeUs(1000), memory).of_line;
  const double counted_cold = cold.weight_of_one(of_line);
  std::printf(
      "a line of memory counts %llu here: the cold table %.0f, of which it costs %.2f times as much\n",
      static_cast<unsigned long long>(of_line), counted_cold, cold_ns / one_ns / counted_cold);
  return counted ? 0 : 1;
}

}  // namespace
}  // namespace vernier

int main(int argc, char** argv) { return vernier::measure(argc > 1 ? std::atoi(argv[1]) : 200); }
