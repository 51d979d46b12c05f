// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/error_table.h"
#include "comp/lag.h"
#include "comp/view.h"

namespace vernier {

/// Limits of a program: these constants fix the memory of the cycle and bound its time.
constexpr std::uint32_t kMaxAxes = 8;
constexpr std::uint32_t kMaxInputs = 24;
constexpr std::uint32_t kMaxRegisters = 1024;
constexpr std::uint32_t kMaxLags = 16;
constexpr std::uint32_t kMaxTables = 64;
/// Largest magnitude of the immediate factors k and l of an instruction.
constexpr std::int32_t kMaxFactor = std::int32_t{1} << 30;
constexpr unsigned kMaxShift = 61;

/// Operation of an instruction on its operands a, b, c (registers, or an index where stated) and immediates
/// k, l. All registers are int32 in a binary format that the compiler chose; the code here does not use the
/// format.
enum class OpCode : std::uint8_t {
  kLinear = 0,    // (a*k + b*l) >> shift, rounded
  kMultiply = 1,  // (a*b) >> shift, rounded
  kDot = 2,       // (k << c, + the first a terms from term l on, - the b terms after them) >> shift, rounded
  kAbs = 3,       // |a|
  kMin = 4,       // lower of a, b
  kMax = 5,       // higher of a, b
  kSign = 6,      // -1, 0, +1
  kEqual = 7,     // a == b ? 1 : 0
  kLess = 8,      // a < b ? 1 : 0
  kWrap = 9,      // a brought into the period of wrap b
  kLookUp = 10,   // all columns of table b at position a: one result a column
  kSineCosine = 11,  // of the angle (a*k) >> shift, 2^-32 turn: two results, 30 fraction bits
  kLag = 12,         // state b += k/2^shift * (a - state b); the state
};
constexpr std::uint8_t kOpCodeCount = static_cast<std::uint8_t>(OpCode::kLag) + 1;

/// One product of a sum of products: (register a * register b) >> shift, truncated. A factor may be one of
/// the constants. The compiler gives the sum of products enough guard bits: the truncation has no visible
/// effect.
struct ProductTerm {
  std::uint16_t a, b;
  std::uint16_t shift;  // 0..62
};
static_assert(sizeof(ProductTerm) == 6);
static_assert(offsetof(ProductTerm, a) == 0 && offsetof(ProductTerm, b) == 2 &&
              offsetof(ProductTerm, shift) == 4);
constexpr std::uint32_t kMaxTerms = 4096;

/// One step of the straight-line program; the results of the step go to the next registers. 16 bytes, as in
/// the image.
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

/// The error equation of a machine. Order of the registers: constants, channels, results. An instruction
/// reads only earlier registers (static single assignment). Non-owning.
struct Equation {
  View<std::int32_t> constants;
  std::uint32_t channel_count = 0;
  View<Instruction> instructions;
  View<ProductTerm> terms;
  View<ErrorTable> tables;
  View<Wrap> wraps;
  std::uint32_t lag_count = 0;
  std::uint32_t result_count = 0;  // of all instructions together

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

/// Executes a VERIFIED equation (comp/verify.h). `registers` contains the constants and channels;
/// run_equation adds the results. registers: register_count() long; lags: lag_count states; `starting` sets
/// every lag to its input. Time of run_equation: one pass over the instructions. The verifier proves that
/// run_equation has no overflow and no access outside the memory. Real-time safe.
void run_equation(const Equation& equation, std::int32_t* registers, LagState* lags, bool starting) noexcept;

}  // namespace vernier
