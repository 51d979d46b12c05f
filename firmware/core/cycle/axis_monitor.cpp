// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/axis_monitor.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

// Beyond every machine and far from overflow in the sums below.
constexpr std::int64_t kMostCounts = std::int64_t{1} << 50;
// Readings whose mean velocity and acceleration are taken; a power of two.
constexpr unsigned kSmoothShift = 4;
// What comes later than that is late; clocks and wake-ups vary by less, and a mean over sixteen takes it out.
constexpr std::int32_t kJitter = kOneTick.count / 8;

constexpr std::int64_t size_of(std::int64_t value) noexcept {
  return value < 0 ? -higher(value, -kMostCounts) : lower(value, kMostCounts);
}

}  // namespace

AxisMonitor::AxisMonitor(const AxisLimits& limits, TimeUs tick, bool gives_motion) noexcept
    : limits_(limits), ticks_per_s_(1'000'000 / tick.count), gives_motion_(gives_motion) {
  frozen_speed_sum_ = limits_.frozen_travel * ticks_per_s_;
}

std::int64_t AxisMonitor::travel_to(AxisPosition position) const noexcept {
  // Unsigned, so that no two readings overflow.
  const auto difference =
      static_cast<std::uint64_t>(position.count) - static_cast<std::uint64_t>(state_.position.count);
  if (limits_.rollover) return static_cast<std::int32_t>(static_cast<std::uint32_t>(difference));
  return static_cast<std::int64_t>(difference);
}

bool AxisMonitor::on_time() const noexcept { return elapsed_.count <= kOneTick.count + kJitter; }

// A controller with an independent clock may have sent one reading more in a longer time. Below 2^50 * 2^13.
std::int64_t AxisMonitor::most_travel() const noexcept {
  if (missing_ == 0 && on_time()) return limits_.step;
  const std::int64_t own = (std::int64_t{missing_} + 1) * kOneTick.count;
  const std::int64_t ticks = higher<std::int64_t>(elapsed_.count, own);
  const std::int64_t once_more = elapsed_.count > own + kJitter ? kOneTick.count : 0;
  return (lower(limits_.step, kMostCounts >> 8) *
          lower<std::int64_t>(ticks + once_more, kMostElapsed.count)) >>
         8;
}

Fault AxisMonitor::check(std::int64_t travel, AxisSpeed velocity, Health& health) noexcept {
  Fault fault = Fault::kNone;
  if (size_of(travel) > most_travel()) {
    ++health.jumps;
    fault = Fault::kPositionJump;
  }
  // Signed, so that the noise of a standing axis' speed averages out.
  const std::int64_t speed = clamp(velocity.count, -kMostCounts, kMostCounts);
  // Of a long silence no more than a second counts: the sum stays far from overflow.
  const std::int64_t ticks_q8 = on_time() ? kOneTick.count : lower<std::int64_t>(elapsed_.count, 1000 << 8);
  const std::int64_t claim = (clamp(speed, -kMostCounts >> 10, kMostCounts >> 10) * ticks_q8) >> 8;
  claimed_ = travel != 0 ? 0 : clamp(claimed_ + claim, -kMostCounts, kMostCounts);
  if (size_of(claimed_) > frozen_speed_sum_) {
    ++health.frozen_readings;
    if (fault == Fault::kNone) fault = Fault::kPositionFrozen;
  }
  return fault;
}

// First-order smoothing by powers of two; the direction changes only when the axis came back further than its
// noise.
void AxisMonitor::derive(std::int64_t any_travel) noexcept {
  const std::int64_t travel = clamp(any_travel, -kMostCounts >> 20, kMostCounts >> 20);
  const std::int64_t in_a_tick = on_time() ? travel : (travel * per_tick_q16(elapsed_)) >> 16;
  const std::int64_t speed = in_a_tick * ticks_per_s_;
  const std::int64_t before = state_.velocity.count;
  const std::int64_t after = before + round_shift(speed - before, kSmoothShift);
  state_.velocity = AxisSpeed(after);
  const std::int64_t acceleration =
      clamp(after - before, -kMostCounts >> 20, kMostCounts >> 20) * ticks_per_s_;
  state_.acceleration.count += round_shift(acceleration - state_.acceleration.count, kSmoothShift);
  const std::int64_t along = state_.sense == 0 ? size_of(travel) : travel * state_.sense;
  back_ = higher<std::int64_t>(0, back_ - along);
  if (state_.sense == 0 && travel != 0) {
    state_.sense = static_cast<std::int8_t>(travel > 0 ? 1 : -1);
  } else if (back_ > limits_.sense_travel) {
    state_.sense = static_cast<std::int8_t>(-state_.sense);
    state_.since = AxisTravel(back_);
    back_ = 0;
  } else if (state_.since.count < kMostCounts) {
    state_.since.count = lower(state_.since.count + size_of(travel), kMostCounts);
  }
}

Fault AxisMonitor::take(bool present, const AxisReading& reading, Health& health, TicksQ8 elapsed) noexcept {
  elapsed_.count = lower(elapsed_.count + elapsed.count, kMostElapsed.count);
  if (!present) {
    ++health.missing_readings;
    missing_ = missing_ < UINT32_MAX ? missing_ + 1 : missing_;
    return missing_ > limits_.missing_ticks ? Fault::kPositionMissing : Fault::kNone;
  }
  if (!known_ || reading.restarted) state_.position = reading.position;
  const std::int64_t travel = travel_to(reading.position);
  const Fault fault = check(travel, gives_motion_ ? reading.velocity : AxisSpeed{}, health);
  if (gives_motion_) {
    state_ =
        AxisInput{reading.position, reading.velocity, reading.acceleration, reading.since, reading.sense};
  } else {
    // A jump is no motion.
    if (fault != Fault::kPositionJump) derive(travel);
    state_.position = reading.position;
  }
  known_ = true;
  missing_ = 0;
  elapsed_.count = 0;
  if (!reading.referenced) {
    ++health.unreferenced;
    return Fault::kReferenceLost;
  }
  return fault;
}

}  // namespace vernier
