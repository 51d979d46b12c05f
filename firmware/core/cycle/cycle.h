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

/// Limits of one axis of the board, if they differ from the limits for its kind of axis (linear or rotary).
struct AxisSetting {
  bool own = false;  // true: `limits` are used instead of the limits for the kind of axis
  AxisLimits limits;
  MotionBounds motion;               // limits of the correction's motion, in addition to the slew limit of
                                     // the image; counts and ticks
  std::int64_t largest = INT32_MAX;  // largest correction that is written for this axis with any image;
                                     // counts
};

/// Limits for the readings of a sensor, 1e-6 of the sensor's unit. A reading beyond a limit is a fault.
struct InputLimits {
  std::int64_t low = INT64_MIN, high = INT64_MAX;
  std::int64_t step = INT64_MAX;  // largest change between two readings
};

/// Limits of the cycle, and limits of the axes that the correction image does not contain. Indices of axes
/// and inputs are those of the board.
struct CycleLimits {
  AxisLimits linear;
  AxisLimits rotary{.step = kTurnCounts / 100, .frozen_travel = kTurnCounts / 3600, .sense_travel = 12000};
  AxisSetting axis[kMaxAxes];
  InputLimits input[kMaxInputs];
  std::uint32_t missing_input_ticks = 100;  // number of ticks for which missing readings of a sensor are
                                            // permitted
};

/// Results of one tick.
struct TickReport {
  CycleOutput output;  // result of the compensator, in the order of the image's axes
  Mode mode;
  Fault latched;
};

/// One tick of the firmware: reads the devices, steps the compensator, writes the corrections. A Cycle never
/// waits for a device. Between two successful writes, the correction at a drive changes by at most the slew
/// limit of its axis. The slew limit is kept for all readings, commands and faults. The `motion` limits of
/// AxisSetting also limit the acceleration of this change. During the ramp-out after a fault, the compensator
/// uses the last valid input, so that the correction can only decrease. The images and the board must exist
/// longer than the cycle.
class Cycle {
 public:
  /// Constructs a cycle for a board whose devices are those of the correction image, in the order of the
  /// image. `view`: a view of the image that was opened without a fault. Not real-time safe.
  Cycle(const ImageView& view, const Board& board, const CycleLimits& limits = {}) noexcept;
  /// Constructs a cycle for a board with wiring but without a program. Not real-time safe.
  Cycle(const Wiring& wiring, TimeUs tick, const Board& board, const CycleLimits& limits = {}) noexcept;

  /// `time`: time since the start (t of the machine file); `outer`: fault that was found outside the tick
  /// (clock, overruns); `elapsed`: time since the previous tick by the clock. Real-time safe.
  TickReport tick(TimeUs time, Command command, Fault outer = Fault::kNone,
                  TicksQ8 elapsed = kOneTick) noexcept;

  /// Replaces the program from the next tick on, without a step of the corrections. The corrections move from
  /// their present values to the values of the new program, within the limits of their axes. The correction
  /// of an axis that the new program does not correct moves to zero. `next`: a program that was bound to the
  /// wiring of this board (bind). The program `next` must exist until the next call of use() returns. use()
  /// returns the previous program. Real-time safe.
  BoundProgram* use(BoundProgram& next) noexcept;

  /// Sets the share (0..1) of the correction that is applied to an axis of the board. The correction changes
  /// within its limits. Real-time safe.
  void set_axis_weight(std::uint32_t axis, WeightQ16 weight) noexcept { axis_weight_[axis] = weight; }
  WeightQ16 axis_weight(std::uint32_t axis) const noexcept { return axis_weight_[axis]; }

  /// Starts the cycle with a fault that was latched before the start of the board. Call before the first
  /// tick. Not real-time safe.
  void restore(Fault fault) noexcept { mode_.restore(fault); }

  Mode mode() const noexcept { return mode_.mode(); }
  bool holding() const noexcept { return mode_.holding(); }
  Fault latched() const noexcept { return mode_.latched(); }
  /// Returns the fault of the last tick, latched or not. In the mode Checking, it is the condition that is
  /// not yet met.
  Fault found() const noexcept { return found_; }
  /// Counts a command that was refused before it reached the cycle. Real-time safe.
  void refuse_command() noexcept { ++health_.refused_commands; }
  /// Returns the share of the correction that is applied at present.
  WeightQ16 weight() const noexcept { return mode_.weight(); }
  Health& health() noexcept { return health_; }
  const Health& health() const noexcept { return health_; }
  /// wanted() returns the correction that the equation requires for an axis of the board at full weight.
  /// achieved() returns the part that the output provides, and limits() the active limits (AxisLimitFlag).
  AxisTravel wanted(std::uint32_t axis) const noexcept { return AxisTravel(drive_[axis].whole); }
  AxisTravel achieved(std::uint32_t axis) const noexcept { return drive_[axis].achieved; }
  std::uint8_t limits(std::uint32_t axis) const noexcept { return drive_[axis].limits; }
  /// Returns the largest change of an axis' correction in one tick, counts; 0 before the first change.
  std::int64_t slew(std::uint32_t axis) const noexcept { return drive_[axis].slew; }
  /// Returns the last correction that was written to an axis of the board.
  AxisTravel written(std::uint32_t axis) const noexcept { return written_[axis]; }
  /// axis_state() returns the newest valid motion of an axis of the board. input_value() returns the newest
  /// valid value of an input of the board.
  const AxisInput& axis_state(std::uint32_t axis) const noexcept { return axes_[axis].state(); }
  InputMicro input_value(std::uint32_t input) const noexcept { return inputs_[input]; }
  const PathReading& path() const noexcept { return path_; }
  const BoundProgram& program() const noexcept { return *now_; }
  /// Returns the start values of the equation in the last tick. Real-time safe.
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
    std::int64_t wanted = 0;  // required correction, counts, within the limit of the board
    std::int64_t whole = 0;   // required correction at full weight, before the limit of the board
    AxisTravel achieved;
    std::uint8_t limits = 0;
    std::int64_t slew = 0;  // largest change, counts per tick; 0: no program has moved this axis yet
    MotionLimit motion;
    AxisTravel pending;  // correction whose write was refused and must be repeated
    bool repeat = false;
  };

  Board board_;
  CycleLimits limits_;
  DenseStore own_dense_;
  std::unique_ptr<BoundProgram> own_;
  BoundProgram* now_;
  ModeControl mode_;
  Fault found_ = Fault::kNone;
  Health health_, idle_health_;                     // health_: counters for the inputs that a program needs;
                                                    // idle_health_: counters for the other inputs
  std::uint32_t axis_count_ = 0, input_count_ = 0;  // number of axes and inputs of the board
  bool uses_axis_[kMaxAxes] = {}, uses_input_[kMaxInputs] = {}, linear_[kMaxAxes] = {};
  AxisMonitor axes_[kMaxAxes];
  InputMicro inputs_[kMaxInputs];
  std::uint32_t silent_[kMaxInputs] = {};  // number of ticks since the last reading
  bool heard_[kMaxInputs] = {};
  PathReading path_;
  CycleInput input_;
  WeightQ16 axis_weight_[kMaxAxes];
  AxisTravel written_[kMaxAxes];
  Drive drive_[kMaxAxes];
  bool at_zero_ = true, settled_ = false, held_ = false;
};

}  // namespace vernier
