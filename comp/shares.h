// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/compensator.h"
#include "comp/verify.h"

namespace vernier {

constexpr std::uint32_t kMaxShares = 512;

/// Share (contribution) of one effect to the correction of one axis, in counts of the axis: correction =
/// -round(register * multiplier / 2^shift).
struct Share {
  std::uint16_t axis;
  std::uint16_t source;  // register of the share equation that contains the result
  std::uint32_t shift;   // 0..61
  std::int32_t multiplier;
};
static_assert(sizeof(Share) == 12);
static_assert(offsetof(Share, axis) == 0 && offsetof(Share, source) == 2 && offsetof(Share, shift) == 4 &&
              offsetof(Share, multiplier) == 8);

/// Program that computes the share of each effect in the correction. The channels of a share program are
/// registers of the tick (control cycle). A share program contains no tables, periods and lags, because the
/// tick has already evaluated them. A share program is executed outside the tick.
struct ShareProgram {
  Equation equation;
  View<std::uint16_t> sources;  // for each channel: index of the tick's register
  View<Share> shares;
};

/// Proves the same properties for a share program as verify_program proves for a program. `program`: a
/// verified program. `ranges`: memory for kMaxRegisters ranges. `ranges` contains the ranges of the program's
/// registers; the function adds the ranges of the shares after them. Not real-time safe.
ProgramFault verify_shares(const ShareProgram& shares, const Program& program, ValueRange* ranges) noexcept;

/// Computes the share of each effect in the correction of one tick, before limits and ramps. The function
/// run_shares computes one value for each element of `shares`, in the same order. The function run_shares
/// executes the equation of the tick again from the start values of the tick. For the display of shares, the
/// tick itself does no work. The share program must be VERIFIED. `state`: state of the same program;
/// `registers`: memory for kMaxRegisters registers. Returns false if the state belongs to another program.
/// Not real-time safe.
bool run_shares(const ShareProgram& shares, const Program& program, const EquationState& state,
                std::int32_t* registers, Correction* corrections) noexcept;

}  // namespace vernier
