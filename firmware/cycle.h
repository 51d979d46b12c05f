// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "firmware/axis_monitor.h"
#include "firmware/health.h"
#include "firmware/mode.h"
#include "hal/board.h"
#include "tables/image_view.h"

namespace vernier {

/// Limits of the cycle; of the axes, those that are not in the image.
struct CycleLimits {
  AxisLimits linear;
  AxisLimits rotary{.step = kTurnCounts / 100, .frozen_travel = kTurnCounts / 3600, .sense_travel = 12000};
  std::uint32_t missing_input_ticks = 100;  // tolerated silence of a sensor
};

/// What came out of a tick.
struct TickReport {
  CycleOutput output;  // what the compensator wanted
  Mode mode;
  Fault latched;
};

/// One tick of the firmware: read the devices, step the compensator, write the corrections. Never waits.
///
/// What reaches a drive changes by at most the slew limit of its axis from one successful write to the next,
/// whatever the readings, commands and faults. While a fault is ramped out the compensator keeps the last
/// good input, so that the correction only shrinks. The image and the board must outlive the cycle.
class Cycle {
 public:
  /// view: opened without fault. setup.
  Cycle(const ImageView& view, const Board& board, const CycleLimits& limits = {}) noexcept;

  /// time: since start (the machine file's t); outer: a fault found around the tick (clock, overruns).
  /// realtime.
  TickReport tick(TimeUs time, Command command, Fault outer = Fault::kNone) noexcept;

  Mode mode() const noexcept { return mode_.mode(); }
  Fault latched() const noexcept { return mode_.latched(); }
  /// Share of the correction that is in.
  WeightQ16 weight() const noexcept { return mode_.weight(); }
  Health& health() noexcept { return health_; }
  const Health& health() const noexcept { return health_; }
  /// The correction that an axis' drive was given last.
  AxisTravel written(std::uint32_t axis) const noexcept { return written_[axis]; }

 private:
  Fault read_axes() noexcept;
  Fault read_inputs() noexcept;
  bool complete() const noexcept;
  void fill_input(TimeUs time) noexcept;
  Fault write(const CycleOutput& output) noexcept;
  void count(const CycleOutput& output) noexcept;

  Board board_;
  Program program_;
  CycleLimits limits_;
  Compensator compensator_;
  ModeControl mode_;
  Health health_;
  AxisMonitor axes_[kMaxAxes];
  InputMicro inputs_[kMaxInputs];
  std::uint32_t silent_[kMaxInputs] = {};  // ticks since the last reading
  bool heard_[kMaxInputs] = {};
  PathReading path_;
  CycleInput input_;
  AxisTravel written_[kMaxAxes];
  AxisTravel pending_[kMaxAxes];  // refused, to be written again
  bool repeat_[kMaxAxes] = {};
  bool at_zero_ = true, settled_ = false;
};

}  // namespace vernier
