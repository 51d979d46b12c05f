// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/compensator.h"
#include "comp/verify.h"

namespace vernier {

constexpr std::uint32_t kMaxShares = 512;

/// Contribution of one effect to the correction of one axis: correction = -round(register * multiplier /
/// 2^shift), axis counts.
struct Share {
  std::uint16_t axis;
  std::uint16_t source;  // register of the share equation
  std::uint32_t shift;   // 0..61
  std::int32_t multiplier;
};
static_assert(sizeof(Share) == 12);
static_assert(offsetof(Share, axis) == 0 && offsetof(Share, source) == 2 && offsetof(Share, shift) == 4 &&
              offsetof(Share, multiplier) == 8);

/// A second equation beside the equation of a program. The channels of a share program are registers of the
/// tick; the results are the shares of the effects. A share program has no tables, periods and lags (the tick
/// has evaluated them) and runs outside the tick.
struct ShareProgram {
  Equation equation;
  View<std::uint16_t> sources;  // for each channel the register of the tick
  View<Share> shares;
};

/// Proves for a share program the properties that verify_program proves for a program. program: verified.
/// ranges: room for kMaxRegisters; contains the ranges of the program's registers; receives the ranges of the
/// shares after them. Not real-time safe.
ProgramFault verify_shares(const ShareProgram& shares, const Program& program, ValueRange* ranges) noexcept;

/// Computes the shares of a tick's correction, before the limits and ramps: one entry per share, in the order
/// of the shares. run_shares executes the equation of the tick again from the start values of the tick. The
/// tick itself does no work for a display. The share program must be VERIFIED. state: state of the same
/// program; registers: room for kMaxRegisters. False if the state is of another program. Not real-time safe.
bool run_shares(const ShareProgram& shares, const Program& program, const EquationState& state,
                std::int32_t* registers, Correction* corrections) noexcept;

}  // namespace vernier
