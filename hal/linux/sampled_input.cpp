// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/sampled_input.h"

#include <cmath>

namespace vernier {
namespace {

constexpr double kMostMicro = 1e18;

}  // namespace

bool SampledInput::scaled(double raw_micro, double offset, double scale, std::int64_t& micro) noexcept {
  const double value = (raw_micro + offset * kPerUnit) * scale;
  if (!(std::fabs(value) < kMostMicro)) return false;
  micro = std::llround(value);
  return true;
}

HalFault SampledInput::sample() noexcept {
  std::int64_t value = 0;
  const HalFault fault = take(value);
  if (fault != HalFault::kNone) {
    good_.store(0, std::memory_order_release);
    return fault;
  }
  // A reader that finds the number of this sample finds its value, or that of a later one.
  if (++samples_ == 0) samples_ = 1;
  value_.store(value, std::memory_order_relaxed);
  good_.store(samples_, std::memory_order_release);
  return HalFault::kNone;
}

HalFault SampledInput::read_input(std::uint32_t input, InputMicro& value) noexcept {
  if (input != 0) return HalFault::kNoDevice;
  const std::uint32_t good = good_.load(std::memory_order_acquire);
  if (good == 0) return HalFault::kNoReading;
  reads_ = good == seen_ ? (reads_ < UINT32_MAX ? reads_ + 1 : reads_) : 0;
  seen_ = good;
  if (reads_ >= stale_reads_) return HalFault::kNoReading;
  value = InputMicro(value_.load(std::memory_order_relaxed));
  return HalFault::kNone;
}

}  // namespace vernier
