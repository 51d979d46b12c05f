// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "firmware/core/cycle/cycle.h"
#include "firmware/linuxcnc/pins.h"
#include "hal/axis_reader.h"
#include "hal/correction_writer.h"

namespace vernier {

/// The joints as LinuxCNC commands them, and the corrections that go to their drives. Commanded values have
/// no noise: speed and acceleration are differences of this tick and the previous ticks, without smoothing. A
/// correction that would move a joint past its limit fades out before the limit. Towards the limit, the
/// correction is at most a share of the distance between command and limit. The share is so small that the
/// correction fades within the slew limit at the joint's greatest speed (the pin max-velocity, or the
/// greatest observed speed if that is larger). The output always changes within the slew limit. The drive
/// stays within the joint's limits if the joint is not faster than the speed above. If the value of a
/// connected pin (command, position or feedback) is not a number, the reading of the joint is missing. After
/// a missing reading the drive's command and the controller's feedback keep their values. If the command
/// jumps to the feedback, the axis has not jumped: the reading continues from the new command. (LinuxCNC
/// makes this jump for a joint that is disabled.) A joint that is not homed has no reference. The reading of
/// such a joint does not change, and continues from the new zero when the joint is homed.
class Joints : public AxisReader, public CorrectionWriter {
 public:
  /// pins: outlive this object. mm_per_unit: unit of the machine's lengths, mm. Not real-time safe.
  Joints(const Pins& pins, const Wiring& wiring, double mm_per_unit = 1) noexcept;

  /// Reads the joints' pins. seconds: period of the servo thread, s. Real-time safe.
  void read(double seconds) noexcept;
  /// Adds the corrections to the commands, and subtracts from the feedback the corrections that were added.
  /// Real-time safe.
  void write() noexcept;
  /// Largest change of a joint's correction in a tick, counts; 0: no change. Real-time safe.
  void set_slew(std::uint32_t joint, std::int64_t counts) noexcept { joints_[joint].slew = counts; }
  bool all_homed() const noexcept { return all_homed_; }
  /// True if the correction would move this joint (or any joint) past its limit. The correction is then
  /// limited. Real-time safe.
  bool at_limit(std::uint32_t joint) const noexcept { return joints_[joint].at_limit; }
  bool any_at_limit() const noexcept;
  /// Reads the position of a joint, in its counts: feedback without the correction. kNoReading: no feedback.
  /// Real-time safe.
  HalFault stands(std::uint32_t joint, AxisPosition& position) const noexcept;

  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override;
  HalFault read_path(PathReading& reading) noexcept override;
  bool gives_motion() const noexcept override { return true; }
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

 private:
  struct Joint {
    const JointPins* pins = nullptr;
    double counts = 1;  // in a unit of the machine
    double jump = 0;    // counts in a tick that no axis travels
    bool known = false, homed = false, given = false, at_limit = false;
    double position = 0, velocity = 0, acceleration = 0;  // units, s
    double back = 0, since = 0;
    int sense = 0;
    double commanded = 0;              // the last command that was a number
    double added = 0;                  // to the command of the tick before
    double fastest = 0;                // that it has been commanded, units/s
    double ticks = 0;                  // since the last reading
    std::int64_t slew = 0;             // counts a tick
    AxisTravel correction, given_out;  // of this tick; after the limit
    AxisReading reading;
  };
  double share_of_way(const Joint& joint) const noexcept;
  static double room_below(const Joint& joint) noexcept;
  static double room_above(const Joint& joint) noexcept;
  void hold(Joint& joint, std::uint32_t i) noexcept;
  static void start(Joint& joint, double position) noexcept;
  static void move(Joint& joint, double position, double per_second) noexcept;
  static double greatest_speed(const Joint& joint) noexcept;
  static bool laid_on_feedback(const Joint& joint, double position, double seconds) noexcept;
  static void lay(Joint& joint, double position) noexcept;
  static void turn(Joint& joint, double travel) noexcept;

  const Pins& pins_;
  std::uint32_t count_;
  double mm_per_unit_;
  double seconds_ = 0.001;  // of a tick
  bool all_homed_ = false;
  Joint joints_[kMaxAxes];
};

/// Positions of the joints, for touches.
class StandingJoints : public AxisReader {
 public:
  /// joints: outlive this object. Not real-time safe.
  explicit StandingJoints(const Joints& joints) noexcept : joints_(joints) {}
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    return joints_.stands(axis, reading.position);
  }
  HalFault read_path(PathReading&) noexcept override { return HalFault::kNoDevice; }
  bool gives_motion() const noexcept override { return false; }

 private:
  const Joints& joints_;
};

}  // namespace vernier
