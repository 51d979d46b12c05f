// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of times to and from the form of the system calls, and the limit for repeating a system call
// that a signal interrupts.
#include <cstdint>
#include <ctime>

namespace vernier {

inline constexpr std::int64_t kNsPerS = 1'000'000'000;
/// Largest number of interruptions of one system call by signals; a larger number is an error.
inline constexpr int kMostInterruptions = 1000;

inline std::int64_t ns_of(const timespec& time) noexcept {
  return std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec;
}
/// `ns`: at least 0.
inline timespec timespec_of(std::int64_t ns) noexcept {
  return {static_cast<time_t>(ns / kNsPerS), static_cast<long>(ns % kNsPerS)};
}

}  // namespace vernier
