// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "hal/input_reader.h"
#include "hal/linux/sysfs_attribute.h"

namespace vernier {

/// value = (what the attribute says + offset) * scale, in the unit of the input, as the kernel defines its
/// in_*_offset and in_*_scale.
struct IioScale {
  double offset = 0;
  double scale = 1;
};

/// A sensor of the kernel's industrial I/O class, or of hwmon: one attribute, say in_temp0_input in 1/1000
/// degC, or in_voltage3_raw. Its own input 0 is the only one.
///
/// A driver may wait for a conversion and for its bus, often milliseconds. So a thread of its own takes the
/// samples, and the tick finds the newest one.
class IioInput : public InputReader {
 public:
  /// attribute: path. stale_reads: reads without a new sample until the sensor counts as silent. Null with
  /// `error` set. setup.
  static std::unique_ptr<IioInput> open(const std::string& attribute, const IioScale& scale,
                                        std::uint32_t stale_reads, std::string& error);

  /// Takes a sample; waits for the driver. Returns what the next reads will. One thread, not the tick's.
  HalFault sample() noexcept;
  /// The newest sample, once per tick. kNoReading: the last attempt failed, there was none yet, or none came
  /// for stale_reads reads. realtime.
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

 private:
  IioInput(SysfsAttribute attribute, const IioScale& scale, std::uint32_t stale_reads)
      : attribute_(std::move(attribute)), scale_(scale), stale_reads_(stale_reads) {}
  HalFault take(std::int64_t& value) noexcept;

  SysfsAttribute attribute_;
  IioScale scale_;
  std::uint32_t stale_reads_;
  std::atomic<std::int64_t> value_{0};
  std::atomic<std::uint32_t> good_{0};  // samples so far; 0: the last attempt failed
  std::uint32_t samples_ = 0;           // of the sampling thread
  std::uint32_t seen_ = 0, reads_ = 0;  // of the tick
};

}  // namespace vernier
