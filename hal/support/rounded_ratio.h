// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/wide.h"

namespace vernier {

/// Computes round(value * numerator / denominator) with halves away from zero. The rounded ratio is exact and
/// needs no division. The ratio numerator / denominator is computed once, in the constructor. The product of
/// a value and the ratio is the exact quotient or one less. The remainder determines whether the
/// product or the product plus one is the exact quotient.
class RoundedRatio {
 public:
  static constexpr std::int64_t kMost = std::int64_t{1} << 50;

  /// `numerator`, `denominator`: 1 to kMost. Not real-time safe.
  constexpr RoundedRatio(std::int64_t numerator, std::int64_t denominator) noexcept
      : numerator_(static_cast<std::uint64_t>(numerator)),
        denominator_(static_cast<std::uint64_t>(denominator)),
        ratio_(numerator_ / denominator_) {
    // ratio_ is numerator * 2^shift_ / denominator without the fraction, at least 2^62. The relative error of
    // ratio_ is below 2^-62.
    for (std::uint64_t rest = numerator_ % denominator_; ratio_ < std::uint64_t{1} << 62; ++shift_) {
      rest *= 2;
      ratio_ *= 2;
      if (rest < denominator_) continue;
      rest -= denominator_;
      ++ratio_;
    }
  }

  /// `value`: limited to +-kMost. The rounded ratio is also limited to +-kMost. Real-time safe.
  constexpr std::int64_t of(std::int64_t value) const noexcept {
    const bool beyond = value >= kMost || value <= -kMost;
    const auto size = static_cast<std::uint64_t>(beyond ? kMost : magnitude_of(value));
    const auto product = long_product(size, ratio_);
    std::uint64_t quotient = kMost;
    if (shift_ >= 64)
      quotient = product.high >> (shift_ - 64);
    else if (product.high >> shift_ == 0)
      quotient = shift_ == 0 ? product.low : product.high << (64 - shift_) | product.low >> shift_;
    if (quotient < kMost) {
      // The remainder is less than twice the denominator, so an overflow of its 64-bit computation
      // has no effect.
      std::uint64_t rest = size * numerator_ - quotient * denominator_;
      if (rest >= denominator_) {
        ++quotient;
        rest -= denominator_;
      }
      if (2 * rest >= denominator_) ++quotient;
    } else {
      quotient = kMost;
    }
    const auto result = static_cast<std::int64_t>(quotient);
    return value < 0 ? -result : result;
  }

 private:
  std::uint64_t numerator_, denominator_, ratio_;
  unsigned shift_ = 0;  // 12 to 113
};

}  // namespace vernier
