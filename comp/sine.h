// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/generated/sine_table.h"

namespace vernier {

/// Sine and cosine of one angle, 30 fraction bits.
struct SineCosine {
  std::int32_t sine, cosine;
};

/// Largest magnitude of a result of sine_cosine: 1 plus the error of sine_cosine.
constexpr std::int32_t kSineLimit = (std::int32_t{1} << 30) + 2;

/// Proved bound of |result - exact| in thousandths of 2^-30. Parts of the error bound, in thousandths of
/// 2^-30: 500 for the rounding of the node (and 500 times 0.0062 for the other node), 63 for omitted terms,
/// 50 for truncations in the series, 500 for the last rounding.
constexpr std::int32_t kSineErrorMilliLsb = 1120;

/// Returns sine and cosine of the angle `turns`, in 2^-32 turn. Any angle `turns` is permitted, and the
/// results are continuous over the whole circle. Method: take the nearest of 512 nodes, then add the angle d
/// from the node (|d| <= pi/512) by the addition theorem, in 37 fraction bits. sin d = d - d^3/6 (remainder
/// below 8e-14), cos d = 1
/// - d^2/2 (remainder d^4/24 < 6e-11). sine_cosine has no branch and no division; the work does not depend on
/// the angle. Real-time safe.
constexpr SineCosine sine_cosine(std::uint32_t turns) noexcept {
  constexpr std::int64_t kRadPerCount = 1686629713;  // 2 pi 2^(37 + 23 - 32), rounded
  constexpr std::int64_t kSixth = 715827883;         // 2^32 / 6
  const std::uint32_t node = (turns + (std::uint32_t{1} << 22)) >> 23;
  const auto count = static_cast<std::int32_t>(turns - (node << 23));  // -2^22 to 2^22
  const std::int64_t d = (count * kRadPerCount) >> 23;
  const std::int64_t square = (d * d) >> 37;
  const std::int64_t sine = d - ((d * ((square * kSixth) >> 32)) >> 37);
  const std::int64_t bend = square >> 1;  // 1 - cosine
  const SineNode& at = kSineTable[node & (kSineNodes - 1)];
  return {narrow(at.sine + round_shift(at.cosine * sine - at.sine * bend, 37)),
          narrow(at.cosine - round_shift(at.sine * sine + at.cosine * bend, 37))};
}

/// Converts an angle in the format of a register to turns: angle * multiplier / 2^shift, truncated, modulo
/// one turn. The product angle * multiplier is below 2^62. Real-time safe.
constexpr std::uint32_t turns_of(std::int32_t angle, std::int32_t multiplier, unsigned shift) noexcept {
  return static_cast<std::uint32_t>((std::int64_t{angle} * multiplier) >> shift);
}

}  // namespace vernier
