// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// A 128-bit integer in two's complement, stored in two words, for exact sums beyond 64 bits. Every operation
/// of Wide is modulo 2^128. A result that fits 128 bits is exact, even if intermediate values overflow.
/// Results of Wide have the same bits on every target.
struct Wide {
  std::uint64_t high = 0, low = 0;
  constexpr bool operator==(const Wide&) const = default;
};

constexpr Wide wide(std::int64_t value) noexcept {
  return {value < 0 ? ~std::uint64_t{0} : 0, static_cast<std::uint64_t>(value)};
}
constexpr bool is_negative(Wide a) noexcept { return (a.high >> 63) != 0; }

/// Returns the sum, the difference or the negative value modulo 2^128. Real-time safe.
constexpr Wide operator+(Wide a, Wide b) noexcept {
  const std::uint64_t low = a.low + b.low;
  return {a.high + b.high + (low < a.low ? 1 : 0), low};
}
constexpr Wide operator-(Wide a, Wide b) noexcept {
  return {a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low};
}
constexpr Wide operator-(Wide a) noexcept { return Wide{} - a; }

/// Returns the exact product of two unsigned 64-bit words, computed as four products of halves. Real-time
/// safe.
constexpr Wide long_product(std::uint64_t a, std::uint64_t b) noexcept {
  constexpr std::uint64_t kHalf = 0xffffffff;
  const std::uint64_t low = (a & kHalf) * (b & kHalf);
  const std::uint64_t left = (a >> 32) * (b & kHalf) + (low >> 32);
  const std::uint64_t right = (a & kHalf) * (b >> 32) + (left & kHalf);
  return {(a >> 32) * (b >> 32) + (left >> 32) + (right >> 32), (right << 32) | (low & kHalf)};
}

/// Returns a * b modulo 2^128. Real-time safe.
constexpr Wide operator*(Wide a, Wide b) noexcept {
  Wide result = long_product(a.low, b.low);
  result.high += a.low * b.high + a.high * b.low;
  return result;
}

/// Returns |a| as an unsigned 128-bit number. Real-time safe.
constexpr Wide magnitude(Wide a) noexcept { return is_negative(a) ? -a : a; }

}  // namespace vernier
