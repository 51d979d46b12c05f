// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <random>

#include "hal/clock.h"

namespace vernier {

/// Simulated time, which passes only in sleep_until and in spend(). A SimClock can wake late by a seeded
/// random time.
class SimClock : public Clock {
 public:
  /// most_late: wake-ups are late by 0..most_late, evenly spread.
  explicit SimClock(InstantNs start = {}, InstantNs most_late = {}, std::uint64_t seed = 1)
      : now_(start), most_late_(most_late), random_(seed) {}

  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    const auto range = static_cast<std::uint64_t>(most_late_.count) + 1;
    const InstantNs late(static_cast<std::int64_t>(random_() % range));
    now_ = std::max(now_, due + late);
    return HalFault::kNone;
  }
  /// Advances the time, as a computation of this duration would.
  void spend(InstantNs time) { now_ = now_ + time; }

 private:
  InstantNs now_, most_late_;
  std::mt19937_64 random_;
};

}  // namespace vernier
