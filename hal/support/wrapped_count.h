// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "hal/support/rounded_ratio.h"

namespace vernier {

/// Converts a counter that wraps around to a continuous position. The change between two counts is always
/// less than half of the range of the counter. The first count determines the start position. A first count
/// in the upper half of the range is a negative position.
class WrappedCount {
 public:
  /// `range`: number of different counts, 2 to 2^40. A count is from 0 to range - 1. Not real-time safe.
  explicit constexpr WrappedCount(std::int64_t range) noexcept : range_(range) {}

  /// Updates the position with the newest count. Returns false and ignores the count if the count is outside
  /// the range. Real-time safe.
  constexpr bool take(std::int64_t count) noexcept {
    if (count < 0 || count >= range_) return false;
    std::int64_t step = count - last_;
    if (step >= range_ - range_ / 2) step -= range_;
    if (step < -(range_ / 2)) step += range_;
    position_ += step;
    last_ = count;
    return true;
  }
  /// Returns the position in counts from the zero of the counter, including all wraps.
  constexpr std::int64_t position() const noexcept { return position_; }
  /// After this call, the next count is treated as the first count.
  constexpr void forget() noexcept { last_ = position_ = 0; }

 private:
  std::int64_t range_, last_ = 0, position_ = 0;
};

/// Scale that converts counts of a device to counts of an axis: round(number * span / counts) + offset.
struct PositionScale {
  std::int64_t span = 1, counts = 1;  // `counts` counts of the device correspond to `span` counts of the axis
                                      // (1 nm, 2^-32 turn); > 0
  std::int64_t offset = 0;            // position at the zero of the device, counts of the axis
  bool inverted = false;              // true: the position decreases if the number increases
};

/// Converts counts of a device to axis positions with a PositionScale. Real-time safe.
class PositionConverter {
 public:
  explicit constexpr PositionConverter(const PositionScale& scale) noexcept
      : scale_(scale), ratio_(scale.span, scale.counts) {}
  constexpr AxisPosition position_of(std::int64_t number) const noexcept {
    const std::int64_t travel = ratio_.of(number);
    return AxisPosition(scale_.offset + (scale_.inverted ? -travel : travel));
  }

 private:
  PositionScale scale_;
  RoundedRatio ratio_;
};

}  // namespace vernier
