// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"

namespace vernier {

/// State of a first-order lag, 30 fraction bits below the input's LSB: a time constant of hours at 1 kHz
/// still moves.
struct LagState {
  std::int64_t value = 0;
};

constexpr unsigned kLagGuardBits = 30;

/// Sets the state to u, as FORMATS defines the start of a lag. Real-time safe.
constexpr void start_lag(LagState& state, std::int32_t u) noexcept {
  state.value = std::int64_t{u} * (std::int64_t{1} << kLagGuardBits);
}

/// state += gain * (u - state); returns the state in u's format, rounded (<= 1/2 LSB).
/// gain = mantissa / 2^shift, mantissa 0..2^31-1, shift 31..62, so 0 <= gain < 1. u - state < 2^62 in guard
/// format; its product with the mantissa is taken in two halves below 2^63. Stays within the range of all u.
/// Real-time safe.
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
