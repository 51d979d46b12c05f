// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/work_budget.h"

#include "comp/equation.h"
#include "comp/verify.h"
#include "firmware/core/cycle/quotient.h"

namespace vernier {
namespace {

constexpr std::uint32_t kTerms = 64, kSums = 32, kRuns = 40;
constexpr int kTries = 8;
constexpr std::size_t kWordsOfLine = 16;  // 64 bytes
constexpr std::uint32_t kJumps = 4096;    // of a try: some hundred microseconds
constexpr std::uint64_t kShareOfTick = 4;

/// An equation of sums of products, each of the one before.
struct Sums {
  ProductTerm terms[kTerms];
  Instruction steps[kSums];
  std::int32_t registers[1 + kSums];
  Equation equation;

  Sums() noexcept {
    for (ProductTerm& term : terms) term = {0, 0, 20};
    for (Instruction& step : steps) step = {OpCode::kDot, 4, kTerms / 2, kTerms / 2, 0, 1, 0};
    registers[0] = 12345;
    equation.channel_count = 1;
    equation.instructions = {steps, kSums};
    equation.terms = {terms, kTerms};
    equation.result_count = kSums;
  }
};

/// The shortest of several tries.
template <class Work>
std::uint64_t best_ns(Clock& clock, int tries, const Work& work) noexcept {
  std::int64_t best = INT64_MAX;
  for (int i = 0; i < tries; ++i) {
    const InstantNs begun = clock.now();
    work();
    const std::int64_t took_ns = (clock.now() - begun).count;
    best = took_ns < best ? took_ns : best;
  }
  return best > 0 ? static_cast<std::uint64_t>(best) : 0;
}

/// ps that a jump to a line takes which the one before names: lines in an order that no processor foresees.
std::uint64_t line_ps(Clock& clock, std::span<std::uint32_t> memory) noexcept {
  std::uint32_t lines = 1;
  while (std::size_t{2} * lines * kWordsOfLine <= memory.size()) lines *= 2;
  // A generator of full period (Knuth, volume 2, 3.2.1.2): each line comes once.
  for (std::uint32_t i = 0; i < lines; ++i)
    memory[std::size_t{i} * kWordsOfLine] = (i * 1664525u + 1013904223u) & (lines - 1);
  std::uint32_t at = 0;
  const std::uint64_t took_ns = best_ns(clock, kTries, [&] {
    for (std::uint32_t k = 0; k < kJumps; ++k) at = memory[std::size_t{at} * kWordsOfLine];
  });
  memory[0] = at;  // so that the jumps are made
  return quotient_of(1000 * took_ns, kJumps);
}

}  // namespace

WorkBudget measured_work_budget(Clock& clock, TimeUs tick, std::span<std::uint32_t> memory) noexcept {
  Sums sums;
  const std::uint64_t took_ns = best_ns(clock, kTries, [&] {
    for (std::uint32_t run = 0; run < kRuns; ++run)
      run_equation(sums.equation, sums.registers, nullptr, false);
  });
  WorkBudget budget;
  if (took_ns == 0) return budget;
  const std::uint64_t share_ns = quotient_of(1000 * static_cast<std::uint64_t>(tick.count), kShareOfTick);
  const std::uint64_t done = kRuns * work_of(sums.equation, 0);
  budget.work = quotient_of(done * share_ns, took_ns);
  if (memory.size() >= 2 * kWordsOfLine)
    budget.of_line = quotient_of(done * line_ps(clock, memory), 1000 * took_ns);
  return budget;
}

bool WorkBudget::covers(const Program& program, const ShareProgram& shares) const noexcept {
  // A budget above 2^50 is not used; lines and their cost are below 2^14 and 2^30.
  const std::uint64_t most = lower(work, std::uint64_t{1} << 50),
                      price = lower(of_line, std::uint64_t{1} << 30);
  const std::uint64_t tick =
      work_of(program.equation, program.channels.size) + price * lines_of(program.equation);
  const std::uint64_t beside =
      work_of(shares.equation, 0) + shares.shares.size + price * lines_of(shares.equation);
  return tick <= most && tick + beside <= kShareWorkFactor * most;
}

}  // namespace vernier
