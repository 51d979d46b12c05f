// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"

namespace vernier {

/// Moves a value towards its target by at most `step` per tick. The condition |change| <= step is met for
/// every sequence of targets. SlewLimit separates the speed of a correction from the table interpolation.
class SlewLimit {
 public:
  /// `target`: counts; `step`: largest change, counts per tick, >= 0. approach() returns the new value.
  /// Real-time safe.
  constexpr std::int32_t approach(std::int32_t target, std::int32_t step) noexcept {
    const std::int64_t wanted = std::int64_t{target} - value_;
    const std::int64_t allowed = clamp<std::int64_t>(wanted, -std::int64_t{step}, step);
    moving_ = allowed != wanted;
    value_ = narrow(value_ + allowed);
    return value_;
  }
  constexpr std::int32_t value() const noexcept { return value_; }
  /// True if the value did not reach its target in the last step.
  constexpr bool limiting() const noexcept { return moving_; }
  /// Continues the motion from `value` instead of the present value.
  constexpr void start_from(std::int32_t value) noexcept { value_ = value, moving_ = false; }
  constexpr void reset() noexcept { value_ = 0, moving_ = false; }

 private:
  std::int32_t value_ = 0;
  bool moving_ = false;
};

}  // namespace vernier
