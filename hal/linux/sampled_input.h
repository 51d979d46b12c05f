// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>

#include "hal/input_reader.h"

namespace vernier {

/// A sensor with a slow answer, often milliseconds. A separate thread reads the samples; the tick gets the
/// newest sample. A SampledInput has input 0 only.
class SampledInput : public InputReader {
 public:
  /// Takes a sample; waits for the device. Returns the result of the next reads. Only one thread may call
  /// sample(), and this thread must not be the thread of the tick.
  HalFault sample() noexcept;
  /// The newest sample, once per tick. kNoReading: the last attempt failed, no sample was taken yet, or no
  /// new sample came for stale_reads reads. Real-time safe.
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

  static constexpr double kPerUnit = 1e6;  // inputs count in millionths of their unit
  /// Converts a raw value to (raw + offset) * scale in 1e-6; false if the result is not a number, or too
  /// large for an input.
  static bool scaled(double raw_micro, double offset, double scale, std::int64_t& micro) noexcept;

 protected:
  /// stale_reads: reads without a new sample after which the sensor counts as missing.
  explicit SampledInput(std::uint32_t stale_reads) : stale_reads_(stale_reads) {}
  /// Takes one sample, 1e-6 of the unit of the input. kNoReading: the device gave no sample. Waits.
  virtual HalFault take(std::int64_t& micro) noexcept = 0;

 private:
  std::uint32_t stale_reads_;
  std::atomic<std::int64_t> value_{0};
  std::atomic<std::uint32_t> good_{0};  // samples so far; 0: the last attempt failed
  std::uint32_t samples_ = 0;           // of the sampling thread
  std::uint32_t seen_ = 0, reads_ = 0;  // of the tick
};

}  // namespace vernier
