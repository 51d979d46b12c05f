// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "firmware/core/cycle/cycle.h"
#include "firmware/linuxcnc/pins.h"
#include "hal/axis_reader.h"
#include "hal/correction_writer.h"

namespace vernier {

/// The joints with the positions that LinuxCNC commands, and the corrections for their drives. The commanded
/// values have no noise. Speed and acceleration of a joint are therefore differences between the present tick
/// and the previous ticks, without smoothing. If a correction would move a joint beyond its limit, the
/// correction decreases to zero before the limit. Near a limit, the correction is at most a share of the
/// distance between command and limit. The share is so small that the correction decreases within the slew
/// limit at the joint's largest speed (the pin max-velocity, or the largest observed speed if it is larger).
/// The correction at the output always changes within the slew limit. The drive stays within the joint's
/// limits if the joint is never faster than the larger of max-velocity and its largest observed speed. If a
/// connected pin (command, position or feedback) has a value that is not a number, the reading of the joint
/// is missing. After a missing reading, the command to the drive and the feedback to the controller keep
/// their values. For a disabled joint LinuxCNC sets the command to the feedback position. This jump of the
/// command is no fault: the position of the axis, from which the correction is computed, continues from the
/// new command. A joint that is not homed has no reference position. The reading of a joint without reference
/// does not change. When the joint is homed, the reading continues from the new zero.
class Joints : public AxisReader, public CorrectionWriter {
 public:
  /// `pins`: must exist longer than this object. `mm_per_unit`: unit of lengths of the machine, mm. Not
  /// real-time safe.
  Joints(const Pins& pins, const Wiring& wiring, double mm_per_unit = 1) noexcept;

  /// Reads the pins of the joints. `seconds`: period of the servo thread, s. Real-time safe.
  void read(double seconds) noexcept;
  /// Adds the corrections to the commands, and subtracts the added corrections from the feedback. Real-time
  /// safe.
  void write() noexcept;
  /// Sets the largest change of a joint's correction in one tick, counts; 0: the correction does not change.
  /// Real-time safe.
  void set_slew(std::uint32_t joint, std::int64_t counts) noexcept { joints_[joint].slew = counts; }
  bool all_homed() const noexcept { return all_homed_; }
  /// True if the correction would move this joint (any_at_limit: any joint) beyond its limit. If the
  /// correction would move a joint beyond its limit, the correction is limited. Real-time safe.
  bool at_limit(std::uint32_t joint) const noexcept { return joints_[joint].at_limit; }
  bool any_at_limit() const noexcept;
  /// Reads the position of a joint in counts: the feedback without the correction. The function stands()
  /// returns kNoReading if there is no feedback. Real-time safe.
  HalFault stands(std::uint32_t joint, AxisPosition& position) const noexcept;

  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override;
  HalFault read_path(PathReading& reading) noexcept override;
  bool gives_motion() const noexcept override { return true; }
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

 private:
  struct Joint {
    const JointPins* pins = nullptr;
    double counts = 1;  // counts per unit of the machine
    double jump = 0;    // travel in one tick, counts, that no axis reaches; a larger travel is a jump
    bool known = false, homed = false, given = false, at_limit = false;
    double position = 0, velocity = 0, acceleration = 0;  // in units of the machine and s
    double back = 0, since = 0;
    int sense = 0;
    double commanded = 0;              // the last command that was a number
    double added = 0;                  // correction that was added to the command in the previous tick
    double fastest = 0;                // largest commanded speed, units/s
    double ticks = 0;                  // number of ticks since the last reading
    std::int64_t slew = 0;             // largest change, counts per tick
    AxisTravel correction, given_out;  // correction of this tick, and correction after the limit
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
  double seconds_ = 0.001;  // duration of a tick
  bool all_homed_ = false;
  Joint joints_[kMaxAxes];
};

/// Reads the positions of the joints for touches of a probe.
class StandingJoints : public AxisReader {
 public:
  /// `joints`: must exist longer than this object. Not real-time safe.
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
