// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/axis_reader.h"
#include "hal/clock.h"
#include "hal/linux/sysfs_attribute.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Directory in which the kernel lists counters.
inline constexpr const char* kCounterRoot = "/sys/bus/counter/devices";

/// The position of an axis from an encoder at a counter of the kernel (Documentation/ABI/testing/
/// sysfs-bus-counter). The position at the count zero is a setting; the board does not know whether the
/// encoder has found its reference mark. A counter gives only the position: the firmware derives the motion.
/// One axis: index 0.
/// In a long time without a reading the axis can pass half the range of the counter, and the counts no longer
/// tell its position: from then on the axis has no reference.
class CounterAxis : public PositionReader {
 public:
  /// Largest speed of the axis: counts of the axis in a tick.
  struct Speed {
    std::int64_t most_per_tick = 1;
    TimeUs tick{1000};
    std::uint32_t missing_ticks = 0;  // ticks without a reading that are no fault
  };
  /// count: directory of the count, ".../counter0/count0". bits: width of the counter, 2 .. 40; 0: the
  /// attribute `ceiling` decides. clock: outlives this object. Returns null with `error` set if the count
  /// cannot be read, is not enabled, or can pass half its range in missing_ticks + 1 ticks.
  /// Not real-time safe.
  static std::unique_ptr<CounterAxis> open(const std::string& count, int bits, const PositionScale& scale,
                                           const Speed& speed, Clock& clock, std::string& error);

  /// Reads the count: two system calls. realtime, if the counter's bus is fast enough.
  void begin_tick() noexcept override;
  /// kNoReading: the driver gave an error, or a count beyond the range of the counter. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;
  /// Directory of the count, without links. Not real-time safe.
  const std::string& place() const noexcept { return place_; }

 private:
  CounterAxis(SysfsAttribute count, std::int64_t range, const PositionScale& scale, InstantNs longest,
              Clock& clock)
      : count_(std::move(count)), wrapped_(range), converter_(scale), longest_(longest), clock_(clock) {}

  SysfsAttribute count_;
  WrappedCount wrapped_;
  PositionConverter converter_;
  InstantNs longest_;  // without a reading
  Clock& clock_;
  InstantNs read_at_;
  std::string place_;
  bool fresh_ = false, known_ = false, lost_ = false;
};

}  // namespace vernier
