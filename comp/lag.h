// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"

namespace vernier {

/// State of a first-order lag, with 30 fraction bits below the LSB of the input. With 30 fraction bits, a
/// lag with a time constant of hours still follows its input at a cycle of 1 kHz.
struct LagState {
  std::int64_t value = 0;
};

constexpr unsigned kLagGuardBits = 30;

/// Sets the state of a lag to its input u, which is the start of a lag by the rules of FORMATS. Real-time
/// safe.
constexpr void start_lag(LagState& state, std::int32_t u) noexcept {
  state.value = std::int64_t{u} * (std::int64_t{1} << kLagGuardBits);
}

/// Computes one step of a lag: state += gain * (u - state). The function returns the state of the lag in the
/// format of u, rounded (<= 1/2 LSB). The gain is mantissa / 2^shift, with mantissa 0..2^31-1 and shift
/// 31..62, so that 0 <= gain < 1. The difference u - state is below 2^62 in the format of the state. The
/// product of (u - state) with the mantissa of the gain is computed in two halves below 2^63. The state stays
/// within the range of all inputs u. Real-time safe.
constexpr std::int32_t step_lag(LagState& state, std::int32_t u, std::int32_t mantissa,
                                unsigned shift) noexcept {
  const std::int64_t difference = std::int64_t{u} * (std::int64_t{1} << kLagGuardBits) - state.value;
  const std::int64_t high = difference >> 31;
  const std::int64_t low = difference & 0x7fffffff;
  const std::int64_t product = high * mantissa + ((low * mantissa) >> 31);
  state.value += product >> (shift - 31);
  return narrow(round_shift(state.value, kLagGuardBits));
}

}  // namespace vernier
