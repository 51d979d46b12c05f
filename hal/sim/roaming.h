// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "hal/sim/trajectory.h"

namespace vernier {

/// Range of an axis that roams, axis counts.
struct RoamingAxis {
  std::int64_t low, high;
};

/// A trajectory in which every axis moves through its range as a sine with seeded period and phase. The speed
/// is at most a given share of the range per second; inputs have given values. Roaming gives exact
/// velocities, accelerations and reversals.
class Roaming : public Trajectory {
 public:
  /// tick: time between two ticks; share_per_s: peak speed over range, 1/s.
  Roaming(const std::vector<RoamingAxis>& axes, std::vector<InputMicro> inputs, TimeUs tick,
          double share_per_s, std::uint64_t seed);
  /// Lets an input oscillate around its value as a sine: amplitude in 1e-6 of its unit. Not real-time safe.
  void vibrate(std::uint32_t input, double amplitude_micro, double frequency_Hz);
  void at(std::int64_t tick, PlantState& state) noexcept override;

 private:
  struct Swing {
    double middle, amplitude;  // counts
    double rate, phase;        // rad/s, rad
  };
  struct Vibration {
    std::size_t input;
    double amplitude, rate;  // 1e-6 of the unit, rad/s
  };
  std::vector<Swing> swings_;
  std::vector<InputMicro> inputs_;
  std::vector<Vibration> vibrations_;
  double tick_s_;
};

}  // namespace vernier
