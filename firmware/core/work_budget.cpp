// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/work_budget.h"

#include "comp/equation.h"
#include "comp/verify.h"
#include "firmware/core/quotient.h"

namespace vernier {
namespace {

constexpr std::uint32_t kTerms = 64, kSums = 32, kRuns = 40;
constexpr int kTries = 8;
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

}  // namespace

std::uint64_t measured_work_budget(Clock& clock, TimeUs tick) noexcept {
  Sums sums;
  std::int64_t best_ns = INT64_MAX;
  for (int i = 0; i < kTries; ++i) {
    const InstantNs begun = clock.now();
    for (std::uint32_t run = 0; run < kRuns; ++run)
      run_equation(sums.equation, sums.registers, nullptr, false);
    const std::int64_t took_ns = (clock.now() - begun).count;
    best_ns = took_ns < best_ns ? took_ns : best_ns;
  }
  if (best_ns <= 0) return kAnyWork;
  const std::uint64_t share_ns = quotient_of(1000 * static_cast<std::uint64_t>(tick.count), kShareOfTick);
  return quotient_of(kRuns * work_of(sums.equation, 0) * share_ns, static_cast<std::uint64_t>(best_ns));
}

}  // namespace vernier
