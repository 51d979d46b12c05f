// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <random>

#include "hal/clock.h"

namespace vernier {

/// Simulated time that passes only in sleep_until() and in spend(). The wake-up of a SimClock can be late by
/// a seeded random time.
class SimClock : public Clock {
 public:
  /// `most_late`: the delay of a wake-up has a uniform distribution from 0 to most_late.
  explicit SimClock(InstantNs start = {}, InstantNs most_late = {}, std::uint64_t seed = 1)
      : now_(start), most_late_(most_late), random_(seed) {}

  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    const auto range = static_cast<std::uint64_t>(most_late_.count) + 1;
    const InstantNs late(static_cast<std::int64_t>(random_() % range));
    now_ = std::max(now_, due + late);
    return HalFault::kNone;
  }
  /// Advances the simulated time, as a computation of this duration would do.
  void spend(InstantNs time) { now_ = now_ + time; }

 private:
  InstantNs now_, most_late_;
  std::mt19937_64 random_;
};

}  // namespace vernier
