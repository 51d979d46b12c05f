// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>

#include "hal/input_reader.h"

namespace vernier {

/// A sensor whose answer takes time, often some milliseconds. A separate thread reads the samples; the tick
/// uses the newest sample. A SampledInput has only one input, with index 0.
class SampledInput : public InputReader {
 public:
  /// Takes a sample. The function waits for the device. sample() returns the result that the next calls of
  /// read_input() will have. Only one thread may call sample(), and this thread must not be the thread of the
  /// tick.
  HalFault sample() noexcept;
  /// Reads the newest sample; called once per tick. The function read_input() returns kNoReading if the last
  /// attempt failed, if no sample was taken yet, or if no new sample came for stale_reads calls. Real-time
  /// safe.
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

  static constexpr double kPerUnit = 1e6;  // inputs are counted in millionths of their unit
  /// Converts a raw value to (raw + offset) * scale in 1e-6. Returns false if the result is not a number or
  /// is too large for an input.
  static bool scaled(double raw_micro, double offset, double scale, std::int64_t& micro) noexcept;

 protected:
  /// `stale_reads`: number of reads without a new sample after which the sensor counts as missing.
  explicit SampledInput(std::uint32_t stale_reads) : stale_reads_(stale_reads) {}
  /// Takes one sample in 1e-6 of the unit of the input. The function take() returns kNoReading if the device
  /// gave no sample. take() waits for the device.
  virtual HalFault take(std::int64_t& micro) noexcept = 0;

 private:
  std::uint32_t stale_reads_;
  std::atomic<std::int64_t> value_{0};
  std::atomic<std::uint32_t> good_{0};  // number of samples; 0: the last attempt failed
  std::uint32_t samples_ = 0;           // used by the sampling thread
  std::uint32_t seen_ = 0, reads_ = 0;  // used by the tick
};

}  // namespace vernier
