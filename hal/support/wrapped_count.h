// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "hal/support/rounded_ratio.h"

namespace vernier {

/// Continues a counter that wraps around. A step is the shortest way: less than half of the range of the
/// counter. The first count determines the start value: a count in the upper half of the range is negative.
class WrappedCount {
 public:
  /// range: number of different counts, 2 .. 2^40; a count is 0 .. range - 1. Not real-time safe.
  explicit constexpr WrappedCount(std::int64_t range) noexcept : range_(range) {}

  /// Takes the newest count. Returns false, and ignores the count, if the count is not in the range.
  /// Real-time safe.
  constexpr bool take(std::int64_t count) noexcept {
    if (count < 0 || count >= range_) return false;
    std::int64_t step = count - last_;
    if (step >= range_ - range_ / 2) step -= range_;
    if (step < -(range_ / 2)) step += range_;
    position_ += step;
    last_ = count;
    return true;
  }
  /// Counts from the zero of the counter, over all its wraps.
  constexpr std::int64_t position() const noexcept { return position_; }
  /// After this call the next count counts as the first count.
  constexpr void forget() noexcept { last_ = position_ = 0; }

 private:
  std::int64_t range_, last_ = 0, position_ = 0;
};

/// Converts counts of a device to counts of an axis: round(number * span / counts) + offset.
struct PositionScale {
  std::int64_t span = 1, counts = 1;  // `counts` of the device are `span` of the axis (1 nm, 2^-32 turn); > 0
  std::int64_t offset = 0;            // position at the device's zero, counts of the axis
  bool inverted = false;              // a larger number is a smaller position
};

/// A scale at work. Real-time safe.
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
