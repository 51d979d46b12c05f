// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// lower() returns the smaller of two values, higher() the larger, and clamp() a value limited to [low,
/// high]. The results of lower(), higher() and clamp() are exact. Real-time safe.
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

/// Returns value / 2^shift, rounded to the nearest integer, ties towards plus infinity. `value`: any format,
/// |value| <= 2^63 - 1 - 2^(shift-1); `shift`: 0..62. The accumulator of round_shift has 64 bits, and no
/// value saturates. The error is at most 1/2 LSB of the result. Real-time safe.
constexpr std::int64_t round_shift(std::int64_t value, unsigned shift) noexcept {
  const std::int64_t half = (std::int64_t{1} << shift) >> 1;
  return (value + half) >> shift;
}

/// Integer type for register values during a computation. The type Word has at least 32 bits and the width
/// with which the processor multiplies fastest. On every target a Word contains only values that fit int32
/// (proved by the verifier). Because each Word contains a value that fits int32, the results do not depend on
/// the width of Word.
using Word = std::int_fast32_t;

/// Converts a value that the caller has proved to fit int32 to a Word. If Word has 64 bits, the
/// conversion to a Word needs no instruction. Real-time safe.
constexpr Word word_of(std::int64_t value) noexcept { return static_cast<Word>(value); }

/// Returns the low 32 bits of a value that the caller has proved to fit int32 (program verifier). Real-time
/// safe.
constexpr std::int32_t narrow(std::int64_t value) noexcept { return static_cast<std::int32_t>(value); }

/// Returns the value if it fits int32. If the value does not fit int32, saturate() returns the
/// nearest limit of int32 and sets `saturated`. The function saturate() never clears `saturated`.
/// Real-time safe.
constexpr std::int32_t saturate(std::int64_t value, bool& saturated) noexcept {
  const std::int64_t limited = clamp<std::int64_t>(value, INT32_MIN, INT32_MAX);
  saturated = saturated || limited != value;
  return narrow(limited);
}

/// Returns the exact product a * b of two register values; it is below 2^62. Real-time safe.
constexpr std::int64_t product(Word a, Word b) noexcept { return std::int64_t{a} * b; }

/// Returns a * b / 2^shift. Formats: `a` Qm, `b` Qn, result Q(m+n-shift). The product has 64 bits and is
/// rounded once (<= 1/2 LSB). The product must fit int32; the caller proves this. `shift`: 0..61. Real-time
/// safe.
constexpr Word multiply(Word a, Word b, unsigned shift) noexcept {
  return word_of(round_shift(product(a, b), shift));
}

/// Returns (a * k + b * l) / 2^shift with one rounding: the weighted sum of two values of any formats, |k|,
/// |l| <= 2^30. `shift`: 0..61. The result fits int32 (proved by the caller). The function linear() is used
/// for sums, differences, scaling and changes of format. Real-time safe.
constexpr Word linear(Word a, std::int32_t k, Word b, std::int32_t l, unsigned shift) noexcept {
  return word_of(round_shift(product(a, k) + product(b, l), shift));
}

/// Returns the sign of a value: -1, 0 or +1. Real-time safe.
constexpr Word sign_of(Word value) noexcept { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// Returns |value| for value > INT32_MIN (proved by the caller). Real-time safe.
constexpr Word magnitude(Word value) noexcept { return value < 0 ? -value : value; }

/// Returns |value| with 64 bits, for value > INT64_MIN (proved by the caller). Real-time safe.
constexpr std::int64_t magnitude_of(std::int64_t value) noexcept { return value < 0 ? -value : value; }

}  // namespace vernier
