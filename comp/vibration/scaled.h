// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>

#include "comp/wide.h"

namespace vernier {

/// A positive number mantissa * 2^exponent, in which bit 63 of the mantissa is set. Zero has the mantissa 0.
/// Scaled is used for ratios and roots of exact integers. The relative error of every operation is at most
/// 2^-59. After a sequence of a dozen operations it is at most 2^-55. The operations of Scaled need no
/// division. Reciprocals and roots use a fixed number of Newton steps.
struct Scaled {
  std::uint64_t mantissa = 0;
  std::int32_t exponent = 0;
};

/// Converts an unsigned 128-bit integer. The upper 64 significant bits are kept (relative error < 2^-63).
/// Real-time safe.
constexpr Scaled scaled(Wide value) noexcept {
  if (value.high == 0) {
    if (value.low == 0) return {};
    const int zeros = std::countl_zero(value.low);
    return {value.low << zeros, -zeros};
  }
  const int zeros = std::countl_zero(value.high);
  const std::uint64_t carried = zeros == 0 ? 0 : value.low >> (64 - zeros);
  return {(value.high << zeros) | carried, 64 - zeros};
}
constexpr Scaled scaled(std::uint64_t value) noexcept { return scaled(Wide{0, value}); }

/// Returns the exact value a * 2^power. Real-time safe.
constexpr Scaled shifted(Scaled a, std::int32_t power) noexcept { return {a.mantissa, a.exponent + power}; }

/// Returns the truncated product a * b (relative error < 2^-62). Real-time safe.
constexpr Scaled operator*(Scaled a, Scaled b) noexcept {
  if (a.mantissa == 0 || b.mantissa == 0) return {};
  const Wide product = long_product(a.mantissa, b.mantissa);
  const int zero = (product.high >> 63) != 0 ? 0 : 1;
  return {(product.high << zero) | (zero != 0 ? product.low >> 63 : 0), a.exponent + b.exponent + 64 - zero};
}

/// Returns y + y * r, the last step of a Newton iteration. `y`: 0..2 with 62 fraction bits; `r`: -1..1 with
/// 62 fraction bits.
constexpr std::uint64_t corrected(std::uint64_t y, std::int64_t r) noexcept {
  const bool down = r < 0;
  const std::uint64_t size =
      down ? std::uint64_t{0} - static_cast<std::uint64_t>(r) : static_cast<std::uint64_t>(r);
  const std::uint64_t move = long_product(y, size).high << 2;
  return down ? y - move : y + move;
}

constexpr std::uint64_t kOneQ62 = std::uint64_t{1} << 62;

/// Returns 1 / a for a > 0. The start value of the iteration is 48/17 - 32/17 d for d = 1/2..1; its error is
/// at most 1/17. Four Newton steps reduce the error to 2e-20. The truncation of the products leaves an error
/// of 2^-60. Real-time safe.
constexpr Scaled reciprocal(Scaled a) noexcept {
  std::uint64_t y = 13021231110853801140u - long_product(a.mantissa, 8680820740569200760u).high;
  for (int step = 0; step < 4; ++step)
    y = corrected(y, static_cast<std::int64_t>(kOneQ62 - long_product(a.mantissa, y).high));
  const int zeros = std::countl_zero(y);  // 1 if 1/d < 2; 0 if 1/d is 2
  return {y << zeros, -62 - 64 - zeros - a.exponent};
}

/// Returns 1 / sqrt(a) for a > 0. The start value of the iteration is 2.15 - 1.24 d for d = 1/4..1; its error
/// is at most 0.1. A Newton step changes the error e to 1.5 e^2. Five steps reach 1e-26; the truncation of
/// the products leaves an error of 2^-59. Real-time safe.
constexpr Scaled inverse_root(Scaled a) noexcept {
  const int odd = a.exponent & 1;
  const std::uint64_t d = a.mantissa >> odd;  // a = d * 2^even, d 2^62..2^64
  const std::int32_t even = a.exponent + odd;
  std::uint64_t y = 9915124939618883584u - long_product(d, 5718490662849960960u).high;
  for (int step = 0; step < 5; ++step) {
    const std::uint64_t square = long_product(y, y).high;           // y^2 with 60 fraction bits
    const std::uint64_t unity = long_product(d, square).high << 2;  // d y^2, 62 fraction bits
    y = corrected(y, static_cast<std::int64_t>(kOneQ62 - unity) >> 1);
  }
  const int zeros = std::countl_zero(y);
  return {y << zeros, -62 - 32 - zeros - even / 2};
}

/// Returns the nearest integer of a, ties upwards; INT64_MAX if the value is larger. Real-time safe.
constexpr std::int64_t count_of(Scaled a) noexcept {
  if (a.mantissa == 0 || a.exponent < -64) return 0;
  if (a.exponent >= 0) return INT64_MAX;
  const auto shift = static_cast<unsigned>(-a.exponent);  // 1..64
  const std::uint64_t floor = shift == 64 ? 0 : a.mantissa >> shift;
  const std::uint64_t rounded = floor + ((a.mantissa >> (shift - 1)) & 1);
  return rounded > static_cast<std::uint64_t>(INT64_MAX) ? INT64_MAX : static_cast<std::int64_t>(rounded);
}

}  // namespace vernier
