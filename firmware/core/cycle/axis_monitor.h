// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "firmware/core/cycle/elapsed.h"
#include "firmware/core/cycle/health.h"
#include "hal/axis_reader.h"
#include "tables/codes.h"

namespace vernier {

/// Limits beyond which a reading of an axis is a fault. All fields are in ticks or axis counts.
struct AxisLimits {
  std::uint32_t missing_ticks = 3;       // tolerated silence
  std::int64_t step = 2'000'000;         // most travel in a tick: 2 mm (2 m/s at 1 kHz)
  std::int64_t frozen_travel = 200'000;  // travel that an unmoving axis may claim: 0.2 mm
  std::int64_t sense_travel = 1'000;     // travel back that counts as a reversal: 1 um
  bool rollover = false;                 // whole turns are no travel
};

/// Checks the readings of one axis for faults. If the controller gives positions only, AxisMonitor computes
/// speed and acceleration from them.
class AxisMonitor {
 public:
  AxisMonitor() = default;
  /// tick: time between two readings; gives_motion: the readings carry the motion state. Not real-time safe.
  AxisMonitor(const AxisLimits& limits, TimeUs tick, bool gives_motion) noexcept;

  /// Takes one reading of the axis; present = false: the reading is missing. Counts faults into health. A
  /// reading that jumps is a fault once; the next readings are compared with it. elapsed: time since the
  /// previous call; a late tick therefore gives no jump and no wrong speed. Real-time safe.
  Fault take(bool present, const AxisReading& reading, Health& health, TicksQ8 elapsed = kOneTick) noexcept;

  bool known() const noexcept { return known_; }
  /// The newest valid motion of the axis; unchanged while readings are missing.
  const AxisInput& state() const noexcept { return state_; }

 private:
  std::int64_t travel_to(AxisPosition position) const noexcept;
  Fault check(std::int64_t travel, AxisSpeed velocity, Health& health) noexcept;
  void derive(std::int64_t any_travel) noexcept;
  bool on_time() const noexcept;
  std::int64_t most_travel() const noexcept;

  AxisLimits limits_;
  std::int64_t frozen_speed_sum_ = 0;  // frozen_travel as a sum of counts/s over ticks
  std::int64_t ticks_per_s_ = 0;
  bool gives_motion_ = true;
  bool known_ = false;
  std::uint32_t missing_ = 0;
  TicksQ8 elapsed_{0};        // since the last reading
  std::int64_t claimed_ = 0;  // sum of speeds since the position last changed
  std::int64_t back_ = 0;     // travel against the direction
  AxisInput state_;
};

}  // namespace vernier
