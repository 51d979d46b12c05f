// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/monotonic_clock.h"

#include <cerrno>
#include <ctime>

namespace vernier {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
// A signal may interrupt a sleep; so many in one sleep are no accident.
constexpr int kMostInterruptions = 1000;

}  // namespace

InstantNs MonotonicClock::now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);  // cannot fail for this clock and a valid pointer
  return InstantNs(std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec);
}

HalFault MonotonicClock::sleep_until(InstantNs due) noexcept {
  if (due.count <= 0) return HalFault::kNone;
  timespec time{};
  time.tv_sec = static_cast<time_t>(due.count / kNsPerS);
  time.tv_nsec = static_cast<long>(due.count % kNsPerS);
  int error = EINTR;
  for (int i = 0; i < kMostInterruptions && error == EINTR; ++i)
    error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
  return error == 0 ? HalFault::kNone : HalFault::kRefused;
}

}  // namespace vernier
