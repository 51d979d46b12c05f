// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/axis_reader.h"
#include "hal/linux/sysfs_attribute.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Directory in which the kernel lists counters.
inline constexpr const char* kCounterRoot = "/sys/bus/counter/devices";

/// The position of an axis from an encoder at a counter of the kernel (Documentation/ABI/testing/
/// sysfs-bus-counter). The position at the count zero is a setting; the board does not know whether the
/// encoder has found its reference mark. A counter gives only the position: the firmware derives the motion.
/// One axis: index 0.
class CounterAxis : public PositionReader {
 public:
  /// count: directory of the count, ".../counter0/count0". bits: width of the counter, 2 .. 40; 0: the
  /// attribute `ceiling` decides. Returns null with `error` set if the count cannot be read, or is not
  /// enabled. Not real-time safe.
  static std::unique_ptr<CounterAxis> open(const std::string& count, int bits, const PositionScale& scale,
                                           std::string& error);

  /// Reads the count: one system call. realtime, if the counter's bus is fast enough.
  void begin_tick() noexcept override;
  /// kNoReading: the driver gave an error, or a count beyond the range of the counter. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;

 private:
  CounterAxis(SysfsAttribute count, std::int64_t range, const PositionScale& scale)
      : count_(std::move(count)), wrapped_(range), converter_(scale) {}

  SysfsAttribute count_;
  WrappedCount wrapped_;
  PositionConverter converter_;
  bool fresh_ = false;
};

}  // namespace vernier
