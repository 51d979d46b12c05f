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

/// Every axis swings through its range as a sine of its own seeded period and phase, at no more than a given
/// share of the range per second; inputs stand at given values. Exact velocities, accelerations and
/// reversals.
class Roaming : public Trajectory {
 public:
  /// tick: time between two ticks; share_per_s: peak speed over range, 1/s.
  Roaming(const std::vector<RoamingAxis>& axes, std::vector<InputMicro> inputs, TimeUs tick,
          double share_per_s, std::uint64_t seed);
  void at(std::int64_t tick, PlantState& state) noexcept override;

 private:
  struct Swing {
    double middle, amplitude;  // counts
    double rate, phase;        // rad/s, rad
  };
  std::vector<Swing> swings_;
  std::vector<InputMicro> inputs_;
  double tick_s_;
};

}  // namespace vernier
