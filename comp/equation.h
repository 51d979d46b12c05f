// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/error_table.h"
#include "comp/lag.h"
#include "comp/view.h"

namespace vernier {

/// Limits that size the memory of the cycle and bound its time.
constexpr std::uint32_t kMaxAxes = 8;
constexpr std::uint32_t kMaxInputs = 24;
constexpr std::uint32_t kMaxRegisters = 1024;
constexpr std::uint32_t kMaxLags = 16;
constexpr std::uint32_t kMaxTables = 64;
constexpr std::uint32_t kMaxColumns = 192;
/// Largest magnitude of the immediate factors k and l of an instruction.
constexpr std::int32_t kMaxFactor = std::int32_t{1} << 30;
constexpr unsigned kMaxShift = 61;

/// What an instruction does with its operands a, b, c (registers, or an index where said) and immediates k,
/// l. All registers are int32 in a binary format that the compiler chose and that this machine need not know.
enum class OpCode : std::uint8_t {
  kLinear,        // (a*k + b*l) >> shift, rounded
  kMultiply,      // (a*b) >> shift, rounded
  kMultiplyAdd,   // (a*b + c*k) >> shift, rounded
  kAbs,           // |a|
  kMin,           // lower of a, b
  kMax,           // higher of a, b
  kSign,          // -1, 0, +1
  kEqual,         // a == b ? 1 : 0
  kLess,          // a < b ? 1 : 0
  kWrap,          // a brought into the period of wrap b
  kSegment,       // number of the segment of table b that holds a
  kFraction,      // fraction (Q30) of a within segment c (a register) of table b
  kLinearColumn,  // between stations c and c+1 of column b, fraction a
  kCubicColumn,   // cubic of segment c of column b, fraction a
  kLag,           // state b += k/2^shift * (a - state b); the state
};
constexpr std::uint8_t kOpCodeCount = static_cast<std::uint8_t>(OpCode::kLag) + 1;

/// One step of the straight-line program; its result goes to the next register. 16 bytes, as in the image.
struct Instruction {
  OpCode op;
  std::uint8_t shift;
  std::uint16_t a, b, c;
  std::int32_t k, l;
};
static_assert(sizeof(Instruction) == 16);

/// The error equation of a machine: registers are first the constants, then the channels, then one per
/// instruction (static single assignment: an instruction reads only registers before its own). Non-owning.
struct Equation {
  View<std::int32_t> constants;
  std::uint32_t channel_count = 0;
  View<Instruction> instructions;
  View<View<Segment>> tables;
  View<View<std::int32_t>> columns;  // linear: one value a station; cubic: four coefficients a segment
  View<Wrap> wraps;
  std::uint32_t lag_count = 0;

  constexpr std::uint32_t first_channel() const { return constants.size; }
  constexpr std::uint32_t first_result() const { return constants.size + channel_count; }
  constexpr std::uint32_t register_count() const { return first_result() + instructions.size; }
};

/// Executes a VERIFIED equation (comp/verify.h): the constants and channels are in `registers`, the results
/// are added. registers: register_count() long; lags: lag_count states; `starting` puts every lag on its
/// input. Time: one pass over the instructions. No overflow, no access outside, by the verifier's proof.
/// realtime.
void run_equation(const Equation& equation, std::int32_t* registers, LagState* lags, bool starting) noexcept;

}  // namespace vernier
