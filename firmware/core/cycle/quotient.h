// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Returns a / b rounded down, computed bit by bit. This division is used during set-up on targets without a
/// 64-bit divider. `b`: 1 to 2^63. Not real-time safe.
constexpr std::uint64_t quotient_of(std::uint64_t a, std::uint64_t b) noexcept {
  std::uint64_t quotient = 0, rest = 0;
  for (int bit = 63; bit >= 0; --bit) {
    rest = rest << 1 | (a >> bit & 1);
    quotient <<= 1;
    if (rest < b) continue;
    rest -= b;
    quotient |= 1;
  }
  return quotient;
}
static_assert(quotient_of(1'000'000'007, 10) == 100'000'000 && quotient_of(7, 8) == 0 &&
              quotient_of(8, 8) == 1);

}  // namespace vernier
