// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/generated/sine_table.h"

namespace vernier {

/// Sine and cosine of the same angle, 30 fraction bits.
struct SineCosine {
  std::int32_t sine, cosine;
};

/// Largest |result| of sine_cosine: 1 plus the error of sine_cosine.
constexpr std::int32_t kSineLimit = (std::int32_t{1} << 30) + 2;

/// Proved bound of |result - exact| in thousandths of 2^-30. Parts: rounding of the node 500 (and 500 times
/// 0.0062 for the other node), omitted terms 63, truncations of the series 50, last rounding 500.
constexpr std::int32_t kSineErrorMilliLsb = 1120;

/// Returns sine and cosine of `turns`, in 2^-32 turn; any value is permitted, and the result is continuous
/// over the whole circle. Method: take the nearest of 512 nodes, then add the angle d from the node (|d| <=
/// pi/512) by the addition theorem, in 37 fraction bits. sin d = d - d^3/6 (remainder below 8e-14), cos d = 1
/// - d^2/2 (remainder d^4/24 < 6e-11). sine_cosine has no branch and no division; the work does not depend on
/// the angle. Real-time safe.
constexpr SineCosine sine_cosine(std::uint32_t turns) noexcept {
  constexpr std::int64_t kRadPerCount = 1686629713;  // 2 pi 2^(37 + 23 - 32), rounded
  constexpr std::int64_t kSixth = 715827883;         // 2^32 / 6
  const std::uint32_t node = (turns + (std::uint32_t{1} << 22)) >> 23;
  const auto count = static_cast<std::int32_t>(turns - (node << 23));  // -2^22 .. 2^22
  const std::int64_t d = (count * kRadPerCount) >> 23;
  const std::int64_t square = (d * d) >> 37;
  const std::int64_t sine = d - ((d * ((square * kSixth) >> 32)) >> 37);
  const std::int64_t bend = square >> 1;  // 1 - cosine
  const SineNode& at = kSineTable[node & (kSineNodes - 1)];
  return {narrow(at.sine + round_shift(at.cosine * sine - at.sine * bend, 37)),
          narrow(at.cosine - round_shift(at.sine * sine + at.cosine * bend, 37))};
}

/// Converts an angle in a register's format to turns: angle * multiplier / 2^shift, truncated, modulo one
/// turn. The product is below 2^62. Real-time safe.
constexpr std::uint32_t turns_of(std::int32_t angle, std::int32_t multiplier, unsigned shift) noexcept {
  return static_cast<std::uint32_t>((std::int64_t{angle} * multiplier) >> shift);
}

}  // namespace vernier
