// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/monotonic_clock.h"

#include <cerrno>

#include "hal/linux/system_time.h"

namespace vernier {

InstantNs MonotonicClock::now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);  // cannot fail for this clock and a valid pointer
  return InstantNs(ns_of(time));
}

HalFault MonotonicClock::sleep_until(InstantNs due) noexcept {
  if (due.count <= 0) return HalFault::kNone;
  const timespec time = timespec_of(due.count);
  int error = EINTR;
  for (int i = 0; i < kMostInterruptions && error == EINTR; ++i)
    error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
  return error == 0 ? HalFault::kNone : HalFault::kRefused;
}

}  // namespace vernier
