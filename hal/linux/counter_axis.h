// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/axis_reader.h"
#include "hal/clock.h"
#include "hal/linux/sysfs_attribute.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Directory in which the Linux kernel lists counters.
inline constexpr const char* kCounterRoot = "/sys/bus/counter/devices";

/// Reads the position of an axis from an encoder at a counter of the Linux kernel (Documentation/ABI/testing/
/// sysfs-bus-counter). The position of the axis at the count zero is a setting. The board does not know
/// whether the encoder has passed its reference mark. A counter gives only the position. The firmware
/// computes the motion from the positions. A CounterAxis has only one axis, with index 0. In a long time
/// without a reading, the axis can move by more than half the range of the counter. After such a long time,
/// the position is unknown, and the axis has no reference any more.
class CounterAxis : public PositionReader {
 public:
  /// Largest speed of the axis, in counts of the axis per tick.
  struct Speed {
    std::int64_t most_per_tick = 1;
    TimeUs tick{1000};
    std::uint32_t missing_ticks = 0;  // number of ticks for which missing readings are permitted
  };
  /// `count`: directory of the count, ".../counter0/count0". `bits`: width of the counter, 2 to 40; 0: the
  /// attribute `ceiling` gives the width. `clock`: must exist longer than this object. Returns null with
  /// `error` set if the count cannot be read, is not enabled, or can change by half its range in
  /// missing_ticks + 1 ticks. Not real-time safe.
  static std::unique_ptr<CounterAxis> open(const std::string& count, int bits, const PositionScale& scale,
                                           const Speed& speed, Clock& clock, std::string& error);

  /// Reads the count with two system calls. The function is real-time safe if the bus of the counter is fast
  /// enough.
  void begin_tick() noexcept override;
  /// The function read_axis() returns kNoReading if the driver gave an error, or a count beyond the range of
  /// the counter. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;
  /// Returns the directory of the count, without symbolic links. Not real-time safe.
  const std::string& place() const noexcept { return place_; }

 private:
  CounterAxis(SysfsAttribute count, std::int64_t range, const PositionScale& scale, InstantNs longest,
              Clock& clock)
      : count_(std::move(count)), wrapped_(range), converter_(scale), longest_(longest), clock_(clock) {}

  SysfsAttribute count_;
  WrappedCount wrapped_;
  PositionConverter converter_;
  InstantNs longest_;  // longest permitted time without a reading
  Clock& clock_;
  InstantNs read_at_;
  std::string place_;
  bool fresh_ = false, known_ = false, lost_ = false;
};

}  // namespace vernier
