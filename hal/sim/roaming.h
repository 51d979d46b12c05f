// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "hal/sim/trajectory.h"

namespace vernier {

/// Range of an axis in the trajectory Roaming, in counts of the axis.
struct RoamingAxis {
  std::int64_t low, high;
};

/// A trajectory in which every axis moves through its range as a sine. Period and phase come from a seeded
/// random generator. The largest speed of an axis is a given share of its range per second. The inputs have
/// given values. Velocities, accelerations and reversals of this trajectory are exact.
class Roaming : public Trajectory {
 public:
  /// `tick`: time between two ticks; `share_per_s`: largest speed divided by the range, 1/s.
  Roaming(const std::vector<RoamingAxis>& axes, std::vector<InputMicro> inputs, TimeUs tick,
          double share_per_s, std::uint64_t seed);
  /// Makes an input oscillate around its value as a sine. The amplitude is in 1e-6 of its unit. Not real-time
  /// safe.
  void vibrate(std::uint32_t input, double amplitude_micro, double frequency_Hz);
  void at(std::int64_t tick, PlantState& state) noexcept override;

 private:
  struct Swing {
    double middle, amplitude;  // counts
    double rate, phase;        // rate in rad/s, phase in rad
  };
  struct Vibration {
    std::size_t input;
    double amplitude, rate;  // amplitude in 1e-6 of the unit, rate in rad/s
  };
  std::vector<Swing> swings_;
  std::vector<InputMicro> inputs_;
  std::vector<Vibration> vibrations_;
  double tick_s_;
};

}  // namespace vernier
