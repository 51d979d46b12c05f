// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/error_table.h"
#include "comp/lag.h"
#include "comp/view.h"

namespace vernier {

/// Limits of a program. The limits of a program determine the memory of the cycle and limit its computing
/// time.
constexpr std::uint32_t kMaxAxes = 8;
constexpr std::uint32_t kMaxInputs = 24;
constexpr std::uint32_t kMaxRegisters = 1024;
constexpr std::uint32_t kMaxLags = 16;
constexpr std::uint32_t kMaxTables = 64;
/// Largest magnitude of the immediate factors k and l of an instruction.
constexpr std::int32_t kMaxFactor = std::int32_t{1} << 30;
constexpr unsigned kMaxShift = 61;

/// Operation of an instruction. The operands a, b, c are registers (or an index where stated); k and l are
/// constants in the instruction. All registers are int32 in a binary format that the compiler selected. The
/// program code does not depend on this format.
enum class OpCode : std::uint8_t {
  kLinear = 0,       // (a*k + b*l) >> shift, rounded
  kMultiply = 1,     // (a*b) >> shift, rounded
  kDot = 2,          // (k << c, + the first a terms from term l on, - the next b terms) >> shift, rounded
  kAbs = 3,          // |a|
  kMin = 4,          // lower of a and b
  kMax = 5,          // higher of a and b
  kSign = 6,         // sign of a: -1, 0, +1
  kEqual = 7,        // a == b ? 1 : 0
  kLess = 8,         // a < b ? 1 : 0
  kWrap = 9,         // a, changed by whole periods into the period of wrap b
  kLookUp = 10,      // values of all columns of table b at position a: one result per column
  kSineCosine = 11,  // sine and cosine of the angle (a*k) >> shift, 2^-32 turn: two results, 30 fraction bits
  kLag = 12,         // state b += k/2^shift * (a - state b); the result is the state
};
constexpr std::uint8_t kOpCodeCount = static_cast<std::uint8_t>(OpCode::kLag) + 1;

/// One product in a sum of products: (register a * register b) >> shift, truncated. A factor of the product
/// may be one of the constants. The compiler gives the sum of products enough guard bits, so that the
/// truncation has no visible effect.
struct ProductTerm {
  std::uint16_t a, b;
  std::uint16_t shift;  // 0..62
};
static_assert(sizeof(ProductTerm) == 6);
static_assert(offsetof(ProductTerm, a) == 0 && offsetof(ProductTerm, b) == 2 &&
              offsetof(ProductTerm, shift) == 4);
constexpr std::uint32_t kMaxTerms = 4096;

/// One instruction of a program without branches. The results of the instruction are written to the next
/// registers. An Instruction has 16 bytes, as in the correction image.
struct Instruction {
  OpCode op;
  std::uint8_t shift;
  std::uint16_t a, b, c;
  std::int32_t k, l;
};
static_assert(sizeof(Instruction) == 16);
static_assert(offsetof(Instruction, op) == 0 && offsetof(Instruction, shift) == 1 &&
              offsetof(Instruction, a) == 2 && offsetof(Instruction, b) == 4 &&
              offsetof(Instruction, c) == 6 && offsetof(Instruction, k) == 8 &&
              offsetof(Instruction, l) == 12);

/// The error equation of a machine. The registers are in the order constants, channels, results. An
/// instruction reads only earlier registers (static single assignment). The Equation does not own its memory.
struct Equation {
  View<std::int32_t> constants;
  std::uint32_t channel_count = 0;
  View<Instruction> instructions;
  View<ProductTerm> terms;
  View<ErrorTable> tables;
  View<Wrap> wraps;
  std::uint32_t lag_count = 0;
  std::uint32_t result_count = 0;  // number of results of all instructions together

  constexpr std::uint32_t first_channel() const { return constants.size; }
  constexpr std::uint32_t first_result() const { return constants.size + channel_count; }
  constexpr std::uint32_t register_count() const { return first_result() + result_count; }
};

/// Returns the number of results of an instruction; 0 if the table of the instruction does not exist.
constexpr std::uint32_t results_of(const Instruction& step, View<ErrorTable> tables) noexcept {
  if (step.op == OpCode::kSineCosine) return 2;
  if (step.op != OpCode::kLookUp) return 1;
  return step.b < tables.size ? tables[step.b].columns : 0;
}

/// Executes a VERIFIED equation (comp/verify.h) from its instructions, without further memory. The dense form
/// (comp/dense.h) needs fewer instructions. Before the call, `registers` contains the constants and the
/// channels. The function run_equation adds the results. `registers`: register_count() values; `lags`:
/// lag_count states; `starting`: true sets every lag to its input. run_equation makes one pass over the
/// instructions. The verifier proves that run_equation has no overflow and no access outside the memory.
/// Real-time safe.
void run_equation(const Equation& equation, std::int32_t* registers, LagState* lags, bool starting) noexcept;

}  // namespace vernier
