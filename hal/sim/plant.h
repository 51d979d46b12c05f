// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/correction_writer.h"
#include "hal/input_reader.h"
#include "hal/sim/trajectory.h"

namespace vernier {

enum class PlantFaultKind : std::uint8_t {
  kMissingPosition,  // the axis gives no reading
  kFrozenAxis,       // the axis repeats its last position, while its speed continues
  kJump,             // the position of the axis has an error of `counts`
  kSensorLost,       // the input gives no reading
  kWriteFailure,     // corrections of the axis are refused by the drive
  kReferenceLost,    // the controller reports that the axis is not referenced
  kSensorWild,       // the reading of the input is too large by `counts`
};

/// One simulated fault. The simulated fault is active during [first, first + ticks) in the tick count of the
/// plant.
struct PlantFault {
  PlantFaultKind kind;
  std::uint32_t index;  // index of the axis or input
  std::int64_t first;
  std::int64_t ticks;
  std::int64_t counts = 0;
};

/// Imperfections of the simulated instruments.
struct PlantOptions {
  std::uint64_t seed = 1;
  double position_noise_counts = 0;  // standard deviation of the noise
  double input_noise_micro = 0;      // standard deviation of the noise
  std::int64_t delay_ticks = 0;      // delay of all readings
  double dropout = 0;                // probability that a reading of an axis is missing
  bool gives_motion = true;
  bool run_in = false;  // true: before release(), the speeds of the first point are reported too
  std::vector<PlantFault> faults;
};

/// A simulated machine that moves on a trajectory. The readings of the plant have the errors of imperfect
/// instruments, from a seeded random generator. With the same seed, SimPlant gives the same readings. The
/// simulated machine stays at the first point of its trajectory until release().
class SimPlant : public AxisReader, public InputReader, public CorrectionWriter {
 public:
  SimPlant(Trajectory& trajectory, std::uint32_t axes, std::uint32_t inputs, PlantOptions options = {});

  /// Begins the next tick of the simulated machine. Call advance() once before each tick of the firmware.
  void advance() noexcept;
  /// Starts the motion of the simulated machine with the next tick.
  void release() noexcept { released_ = true; }
  /// Returns the number of ticks since the construction. Tick 0 is the tick after the first call of
  /// advance().
  std::int64_t tick() const noexcept { return tick_; }
  /// Returns the tick of the trajectory; 0 before release() is called.
  std::int64_t path_tick() const noexcept { return path_tick_; }
  /// Returns the correction that the drive of an axis has.
  AxisTravel written(std::uint32_t axis) const noexcept { return written_[axis]; }

  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override;
  HalFault read_path(PathReading& reading) noexcept override;
  bool gives_motion() const noexcept override { return options_.gives_motion; }
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;

 private:
  const PlantFault* active_fault(PlantFaultKind kind, std::uint32_t index) const noexcept;
  void spoil_axis(std::uint32_t axis) noexcept;
  void spoil_inputs() noexcept;

  Trajectory& trajectory_;
  std::uint32_t axes_, inputs_;
  PlantOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0, 1};
  PlantState seen_;
  bool missing_[kMaxAxes] = {};
  AxisPosition frozen_[kMaxAxes];
  AxisTravel written_[kMaxAxes];
  std::int64_t tick_ = -1, path_tick_ = 0;
  bool released_ = false, moving_ = false;
};

}  // namespace vernier
