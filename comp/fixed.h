// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Lower of two, higher of two, and value limited to [low, high]. Exact. Real-time safe.
template <class Integer>
constexpr Integer lower(Integer a, Integer b) noexcept {
  return b < a ? b : a;
}
template <class Integer>
constexpr Integer higher(Integer a, Integer b) noexcept {
  return a < b ? b : a;
}
template <class Integer>
constexpr Integer clamp(Integer value, Integer low, Integer high) noexcept {
  return lower(higher(value, low), high);
}

/// value / 2^shift, rounded to nearest, ties towards plus infinity.
/// value: any format, |value| <= 2^63 - 1 - 2^(shift-1); shift: 0..62. Accumulator 64 bit, nothing saturates.
/// Error <= 1/2 LSB of the result. Real-time safe.
constexpr std::int64_t round_shift(std::int64_t value, unsigned shift) noexcept {
  const std::int64_t half = (std::int64_t{1} << shift) >> 1;
  return (value + half) >> shift;
}

/// A register's value in flight: at least 32 bits, the size that the processor multiplies fastest. A Word
/// holds an int32 on every target (proved by the verifier), so that results do not depend on the width of
/// Word.
using Word = std::int_fast32_t;

/// A value that the caller has proved to fit int32, as a Word: no instruction if Word has 64 bits.
/// Real-time safe.
constexpr Word word_of(std::int64_t value) noexcept { return static_cast<Word>(value); }

/// The low 32 bits of a value that the caller has proved to fit (program verifier). Real-time safe.
constexpr std::int32_t narrow(std::int64_t value) noexcept { return static_cast<std::int32_t>(value); }

/// Returns value if the value fits int32, else the nearest limit of int32 and sets `saturated`. `saturated`
/// is never cleared. Real-time safe.
constexpr std::int32_t saturate(std::int64_t value, bool& saturated) noexcept {
  const std::int64_t limited = clamp<std::int64_t>(value, INT32_MIN, INT32_MAX);
  saturated = saturated || limited != value;
  return narrow(limited);
}

/// Returns a * b, exact: the product of two register values, below 2^62. Real-time safe.
constexpr std::int64_t product(Word a, Word b) noexcept { return std::int64_t{a} * b; }

/// a * b / 2^shift. a: format Qm, b: Qn, result: Q(m+n-shift); 64-bit product, one rounding (<= 1/2 LSB).
/// The result must fit int32 (proved by the caller). shift: 0..61. Real-time safe.
constexpr Word multiply(Word a, Word b, unsigned shift) noexcept {
  return word_of(round_shift(product(a, b), shift));
}

/// (a * k + b * l) / 2^shift with one rounding: weighted sum of two values of any formats, |k|, |l| <= 2^30.
/// shift: 0..61; the result fits int32 (proved by the caller). Sum, difference, scaling and change of format.
/// Real-time safe.
constexpr Word linear(Word a, std::int32_t k, Word b, std::int32_t l, unsigned shift) noexcept {
  return word_of(round_shift(product(a, k) + product(b, l), shift));
}

/// -1, 0 or +1. Real-time safe.
constexpr Word sign_of(Word value) noexcept { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// |value|; value > INT32_MIN (proved by the caller). Real-time safe.
constexpr Word magnitude(Word value) noexcept { return value < 0 ? -value : value; }

/// |value|, 64 bit; value > INT64_MIN (proved by the caller). Real-time safe.
constexpr std::int64_t magnitude_of(std::int64_t value) noexcept { return value < 0 ? -value : value; }

}  // namespace vernier
