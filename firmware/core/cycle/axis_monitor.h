// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "firmware/core/cycle/elapsed.h"
#include "firmware/core/cycle/health.h"
#include "hal/axis_reader.h"
#include "tables/codes.h"

namespace vernier {

/// Limits for the readings of an axis. A reading beyond a limit is a fault. All limits are in ticks or axis
/// counts.
struct AxisLimits {
  std::uint32_t missing_ticks = 3;       // number of ticks for which missing readings are permitted
  std::int64_t step = 2'000'000;         // largest travel in one tick: 2 mm (2 m/s at 1 kHz)
  std::int64_t frozen_travel = 200'000;  // largest travel that the speed of an axis may indicate while its
                                         // position does not change: 0.2 mm
  std::int64_t sense_travel = 1'000;     // travel in the opposite direction that counts as a reversal: 1 um
  bool rollover = false;                 // true: a difference of whole turns is no travel
};

/// Checks the readings of one axis for faults. If the controller gives only positions, AxisMonitor computes
/// speed and acceleration from them.
class AxisMonitor {
 public:
  AxisMonitor() = default;
  /// `tick`: time between two readings; `gives_motion`: true if the readings contain the motion (speed,
  /// acceleration). Not real-time safe.
  AxisMonitor(const AxisLimits& limits, TimeUs tick, bool gives_motion) noexcept;

  /// Takes one reading of the axis. `present` = false: the reading is missing. The function counts faults in
  /// `health`. A reading that jumps is a fault only once, because the next readings are compared with the new
  /// position. `elapsed`: time since the previous call. Because the elapsed time is known, a late
  /// tick is not detected as a jump or a wrong speed of the axis. Real-time safe.
  Fault take(bool present, const AxisReading& reading, Health& health, TicksQ8 elapsed = kOneTick) noexcept;

  bool known() const noexcept { return known_; }
  /// Returns the newest valid motion of the axis. The value does not change while readings are missing.
  const AxisInput& state() const noexcept { return state_; }

 private:
  std::int64_t travel_to(AxisPosition position) const noexcept;
  Fault check(std::int64_t travel, AxisSpeed velocity, Health& health) noexcept;
  void derive(std::int64_t any_travel) noexcept;
  bool on_time() const noexcept;
  std::int64_t most_travel() const noexcept;

  AxisLimits limits_;
  std::int64_t frozen_speed_sum_ = 0;  // frozen_travel, converted to a sum of speeds (counts/s) over ticks
  std::int64_t ticks_per_s_ = 0;
  bool gives_motion_ = true;
  bool known_ = false;
  std::uint32_t missing_ = 0;
  TicksQ8 elapsed_{0};        // time since the last reading
  std::int64_t claimed_ = 0;  // sum of the speeds since the last change of the position
  std::int64_t back_ = 0;     // travel against the present direction
  AxisInput state_;
};

}  // namespace vernier
