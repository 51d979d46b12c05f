// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/quantity.h"
#include "firmware/core/cycle/quotient.h"

namespace vernier {

/// Time between two readings, in 1/256 of a tick. The time between two readings is 256 if both readings were
/// on time. A time of less than one tick counts as one tick. Reason: after a late tick, the next tick reads
/// positions that the controller sends at a constant rate.
struct TicksQ8 {
  std::int32_t count = 256;
};
constexpr TicksQ8 kOneTick{256};
/// Largest elapsed time that the firmware uses. A longer elapsed time is a fault, for example a clock that
/// steps by a second. With the limit of the elapsed time, sums of elapsed times fit 32 bits.
constexpr TicksQ8 kMostElapsed{1 << 20};

/// Converts times to ticks without a division in the tick.
class ElapsedTicks {
 public:
  ElapsedTicks() = default;
  /// `tick`: duration of a tick, 1 us to 1 s. Not real-time safe.
  explicit ElapsedTicks(TimeUs tick) noexcept
      : per_ns_(static_cast<std::int64_t>(
            quotient_of((std::uint64_t{256} << kShift) + 500 * static_cast<std::uint64_t>(tick.count),
                        1000 * static_cast<std::uint64_t>(tick.count)))) {}
  /// Converts a time to ticks, rounded to the nearest; at least one tick, at most kMostElapsed.
  /// Real-time safe.
  TicksQ8 of(InstantNs time) const noexcept {
    // For times above 2^30 ns the result is at the limit if the tick is shorter than 1 ms; for longer ticks
    // such a time is few ticks.
    const std::int64_t ns = clamp<std::int64_t>(time.count, 0, std::int64_t{1} << 30);
    const std::int64_t ticks = (ns * per_ns_ + (std::int64_t{1} << (kShift - 1))) >> kShift;
    return TicksQ8{static_cast<std::int32_t>(clamp<std::int64_t>(ticks, kOneTick.count, kMostElapsed.count))};
  }

 private:
  static constexpr unsigned kShift = 24;
  std::int64_t per_ns_ = 0;  // 256 / (duration of a tick in ns), Q24: below 2^23, because a tick has at least
                             // 1 us
};

/// Returns 2^24 / elapsed, rounded down. This quotient is the factor (Q16) that converts a travel since the
/// last reading to a travel per tick. The quotient is computed bit by bit, for targets without a divider.
/// `elapsed`: 1 to kMostElapsed. Real-time safe.
constexpr std::int64_t per_tick_q16(TicksQ8 elapsed) noexcept {
  std::uint32_t rest = 0, quotient = 0;
  for (int bit = 24; bit >= 0; --bit) {
    rest = rest << 1 | (bit == 24 ? 1u : 0u);
    quotient <<= 1;
    if (rest >= static_cast<std::uint32_t>(elapsed.count)) {
      rest -= static_cast<std::uint32_t>(elapsed.count);
      quotient |= 1;
    }
  }
  return quotient;
}
static_assert(per_tick_q16(kOneTick) == 65536);
static_assert(per_tick_q16(TicksQ8{512}) == 32768 && per_tick_q16(kMostElapsed) == 16);

}  // namespace vernier
