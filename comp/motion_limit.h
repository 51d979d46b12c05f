// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"

namespace vernier {

/// Acceleration that means "no limit". With this acceleration a value can move any distance in one tick.
constexpr std::int64_t kAnyAcceleration = std::int64_t{1} << 40;

/// Limits for the motion of a correction: the largest change in counts per tick, and the largest change of
/// this change in counts per tick per tick.
struct MotionBounds {
  std::int64_t slew = INT32_MAX;                 // 0 to 2^31 - 1
  std::int64_t acceleration = kAnyAcceleration;  // 1 to 2^31 - 1, or kAnyAcceleration
};

/// Moves a value towards its target within a speed and an acceleration limit. The value brakes in time, so
/// that it does not overshoot a constant target. The conditions |change| <= slew and |change of change| <=
/// acceleration are met for every sequence of targets, as long as the limits do not change. If the target
/// comes nearer than the braking distance, the value overshoots the target with the permitted acceleration.
class MotionLimit {
 public:
  /// `target`: counts, |target| <= 2^31. approach() returns the new value. The computing time is constant (31
  /// steps). Real-time safe.
  constexpr std::int64_t approach(std::int64_t target, const MotionBounds& bounds) noexcept {
    const std::int64_t way = target - value_;
    const std::int64_t low = higher(speed_ - bounds.acceleration, -bounds.slew),
                       high = lower(speed_ + bounds.acceleration, bounds.slew);
    const std::int64_t wanted =
        way >= 0 ? braking_speed(way, bounds.acceleration) : -braking_speed(-way, bounds.acceleration);
    // If a limit was reduced during a motion, the value first decelerates to the new limit.
    speed_ = low <= high ? clamp(wanted, low, high) : (speed_ > 0 ? low : high);
    value_ += speed_;
    return value_;
  }
  constexpr std::int64_t value() const noexcept { return value_; }
  constexpr std::int64_t speed() const noexcept { return speed_; }
  /// Sets the value without a limit, and sets the speed to zero. Used when the correction starts,
  /// and if a drive refused to move.
  constexpr void stop_at(std::int64_t value) noexcept { value_ = value, speed_ = 0; }

  /// Returns a speed from which `way` counts are sufficient to stop: (v + a/2)^2 <= 2 a way. The distance (v
  /// + a/2)^2 / (2 a) is at least the sum v + (v - a) + (v - 2a) ... of the ticks to a stop, and at most a/8
  /// more. If one tick is sufficient, the speed is `way`. `way`: >= 0; `acceleration`: as in MotionBounds.
  /// Both sides of the condition for braking stay below 2^64. Real-time safe.
  static constexpr std::int64_t braking_speed(std::int64_t way, std::int64_t acceleration) noexcept {
    if (way <= acceleration) return way;
    const auto a = static_cast<std::uint64_t>(acceleration);
    const std::uint64_t room =
        static_cast<std::uint64_t>(lower<std::int64_t>(way, std::int64_t{1} << 31)) * a * 2;
    std::uint64_t speed = 0;
    for (std::uint64_t bit = std::uint64_t{1} << 30; bit != 0; bit >>= 1) {
      const std::uint64_t next = speed | bit;
      if (next * (next + a) + (a * a + 3) / 4 <= room) speed = next;
    }
    return static_cast<std::int64_t>(speed);
  }

 private:
  std::int64_t value_ = 0, speed_ = 0;
};

}  // namespace vernier
