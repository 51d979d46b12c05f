// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/compensator.h"
#include "comp/verify.h"

namespace vernier {

constexpr std::uint32_t kMaxShares = 512;

/// What one effect adds to the correction of one axis: correction = -round(register * multiplier / 2^shift),
/// axis counts.
struct Share {
  std::uint16_t axis;
  std::uint16_t source;  // register of the share equation
  std::uint32_t shift;   // 0..61
  std::int32_t multiplier;
};
static_assert(sizeof(Share) == 12);
static_assert(offsetof(Share, axis) == 0 && offsetof(Share, source) == 2 && offsetof(Share, shift) == 4 &&
              offsetof(Share, multiplier) == 8);

/// A second equation beside the equation of a program. Its channels are registers of the tick, its results
/// the shares of the effects. It has no tables, periods and lags (the tick has evaluated them) and runs
/// outside the tick.
struct ShareProgram {
  Equation equation;
  View<std::uint16_t> sources;  // for each channel the register of the tick
  View<Share> shares;
};

/// Proves for a share program the properties that verify_program proves for a program. program: verified;
/// ranges: room for kMaxRegisters, contains the ranges of the program's registers, gets those of the shares
/// after them. setup.
ProgramFault verify_shares(const ShareProgram& shares, const Program& program, ValueRange* ranges) noexcept;

/// The shares of a tick's correction, before its limits and ramps: one entry per share, in their order. The
/// tick is executed again from its start values: a tick never does work for a display. Needs a VERIFIED share
/// program. state: of the same program; registers: room for kMaxRegisters. False if the state is of another
/// program. setup.
bool run_shares(const ShareProgram& shares, const Program& program, const EquationState& state,
                std::int32_t* registers, Correction* corrections) noexcept;

}  // namespace vernier
