// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "comp/motion_limit.h"
#include "firmware/core/cycle/axis_monitor.h"
#include "firmware/core/cycle/bound_program.h"
#include "firmware/core/cycle/health.h"
#include "firmware/core/cycle/mode.h"
#include "hal/board.h"
#include "tables/image_view.h"

namespace vernier {

/// Limits of one axis of the board, if they differ from the rule for the kind of axis.
struct AxisSetting {
  bool own = false;  // `limits` count instead of those of the kind
  AxisLimits limits;
  MotionBounds motion;               // of the correction, on top of the image's slew limit; counts and ticks
  std::int64_t largest = INT32_MAX;  // largest correction that is ever written, for every image; counts
};

/// Limits beyond which a reading of a sensor is a fault; 1e-6 of the sensor's unit.
struct InputLimits {
  std::int64_t low = INT64_MIN, high = INT64_MAX;
  std::int64_t step = INT64_MAX;  // between two readings
};

/// Limits of the cycle, and those limits of the axes that the correction image does not contain. Indices of
/// axes and inputs are those of the board.
struct CycleLimits {
  AxisLimits linear;
  AxisLimits rotary{.step = kTurnCounts / 100, .frozen_travel = kTurnCounts / 3600, .sense_travel = 12000};
  AxisSetting axis[kMaxAxes];
  InputLimits input[kMaxInputs];
  std::uint32_t missing_input_ticks = 100;  // tolerated silence of a sensor
};

/// Results of one tick.
struct TickReport {
  CycleOutput output;  // result of the compensator, by axis of the image
  Mode mode;
  Fault latched;
};

/// One tick of the firmware: reads the devices, steps the compensator, writes the corrections. A Cycle never
/// waits. From one successful write to the next, the value at a drive changes by at most the slew limit of
/// its axis. This limit is valid for all readings, commands and faults. AxisSetting limits the acceleration
/// of the change. During the ramp-out after a fault the compensator uses the last valid input: the correction
/// can only decrease. The images and the board must outlive the cycle.
class Cycle {
 public:
  /// Constructs a cycle for a board whose devices are those of the correction image, in the order of the
  /// image. view: opened without fault. Not real-time safe.
  Cycle(const ImageView& view, const Board& board, const CycleLimits& limits = {}) noexcept;
  /// A board with wiring but without a program. Not real-time safe.
  Cycle(const Wiring& wiring, TimeUs tick, const Board& board, const CycleLimits& limits = {}) noexcept;

  /// time: since start (the machine file's t); outer: a fault found around the tick (clock, overruns);
  /// elapsed: since the tick before, by the clock. Real-time safe.
  TickReport tick(TimeUs time, Command command, Fault outer = Fault::kNone,
                  TicksQ8 elapsed = kOneTick) noexcept;

  /// Continues with another program from the next tick, without a step. Corrections move from their present
  /// values, within the limits of their axes. Axes that the new program does not correct go to zero. next:
  /// bound to this board's wiring (bind), lives until the next use() returns. Returns the previous program.
  /// Real-time safe.
  BoundProgram* use(BoundProgram& next) noexcept;

  /// Share of the correction of a board's axis that is applied, 0..1; changes within the limits.
  /// Real-time safe.
  void set_axis_weight(std::uint32_t axis, WeightQ16 weight) noexcept { axis_weight_[axis] = weight; }
  WeightQ16 axis_weight(std::uint32_t axis) const noexcept { return axis_weight_[axis]; }

  /// Starts with a fault that was latched before the start. Call before the first tick. Not real-time safe.
  void restore(Fault fault) noexcept { mode_.restore(fault); }

  Mode mode() const noexcept { return mode_.mode(); }
  bool holding() const noexcept { return mode_.holding(); }
  Fault latched() const noexcept { return mode_.latched(); }
  /// Returns the fault of the last tick, latched or not; while checking, the condition that is not met yet.
  Fault found() const noexcept { return found_; }
  /// Counts a command that was refused before it came here. Real-time safe.
  void refuse_command() noexcept { ++health_.refused_commands; }
  /// Returns the share of the correction that is applied now.
  WeightQ16 weight() const noexcept { return mode_.weight(); }
  Health& health() noexcept { return health_; }
  const Health& health() const noexcept { return health_; }
  /// Returns the correction that the equation requires of an axis of the board at full weight, the part that
  /// its output gives, and the active limits (AxisLimitFlag).
  AxisTravel wanted(std::uint32_t axis) const noexcept { return AxisTravel(drive_[axis].whole); }
  AxisTravel achieved(std::uint32_t axis) const noexcept { return drive_[axis].achieved; }
  std::uint8_t limits(std::uint32_t axis) const noexcept { return drive_[axis].limits; }
  /// Returns the largest change of the correction of a board's axis in a tick, counts; 0 before the first
  /// change.
  std::int64_t slew(std::uint32_t axis) const noexcept { return drive_[axis].slew; }
  /// The last correction that was written to an axis of the board.
  AxisTravel written(std::uint32_t axis) const noexcept { return written_[axis]; }
  /// The newest valid motion of an axis of the board (axis_state), and the newest valid value of an input of
  /// the board (input_value).
  const AxisInput& axis_state(std::uint32_t axis) const noexcept { return axes_[axis].state(); }
  InputMicro input_value(std::uint32_t input) const noexcept { return inputs_[input]; }
  const PathReading& path() const noexcept { return path_; }
  const BoundProgram& program() const noexcept { return *now_; }
  /// Start values of the last tick. Real-time safe.
  void equation_state(EquationState& state) const noexcept { now_->compensator.state(state); }

 private:
  void set_up(const Wiring& wiring, TimeUs tick) noexcept;
  Fault read_axes(TicksQ8 elapsed) noexcept;
  Fault read_inputs() noexcept;
  Fault take_input(std::uint32_t input, InputMicro value) noexcept;
  FeedNmPerMin feed_of_axes() const noexcept;
  bool complete() const noexcept;
  void fill_input(TimeUs time) noexcept;
  void collect_wishes(const CycleOutput& output) noexcept;
  Fault write(const CycleOutput& output) noexcept;
  bool write_axis(std::uint32_t axis) noexcept;
  void judge_limits(std::uint32_t axis) noexcept;
  void count(const CycleOutput& output) noexcept;

  /// The value for the drive of one axis of the board.
  struct Drive {
    std::int64_t wanted = 0;  // counts, within the board's limit
    std::int64_t whole = 0;   // the same at full weight, before that limit
    AxisTravel achieved;
    std::uint8_t limits = 0;
    std::int64_t slew = 0;  // counts a tick; 0: no program has moved this axis yet
    MotionLimit motion;
    AxisTravel pending;  // refused, to be written again
    bool repeat = false;
  };

  Board board_;
  CycleLimits limits_;
  std::unique_ptr<BoundProgram> own_;
  BoundProgram* now_;
  ModeControl mode_;
  Fault found_ = Fault::kNone;
  Health health_, idle_health_;                     // of the inputs that a program needs; of the others
  std::uint32_t axis_count_ = 0, input_count_ = 0;  // of the board
  bool uses_axis_[kMaxAxes] = {}, uses_input_[kMaxInputs] = {}, linear_[kMaxAxes] = {};
  AxisMonitor axes_[kMaxAxes];
  InputMicro inputs_[kMaxInputs];
  std::uint32_t silent_[kMaxInputs] = {};  // ticks since the last reading
  bool heard_[kMaxInputs] = {};
  PathReading path_;
  CycleInput input_;
  WeightQ16 axis_weight_[kMaxAxes];
  AxisTravel written_[kMaxAxes];
  Drive drive_[kMaxAxes];
  bool at_zero_ = true, settled_ = false, held_ = false;
};

}  // namespace vernier
