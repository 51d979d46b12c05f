// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"

namespace vernier {

/// Wakes a thread that waits in wait() or in a poll() of the handle. A wake-up before the wait ends the wait
/// immediately.
class WakeUp {
 public:
  /// Never throws: if the system has no more handles, waits end after their time only. Not real-time safe.
  WakeUp() noexcept;
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void wake() noexcept;
  /// Waits at most `wait` for a wake-up, and clears the wake-up. Not real-time safe.
  void wait(TimeUs wait) noexcept;
  /// handle() is for poll(). After poll() call clear(), which clears the wake-up.
  int handle() const noexcept { return fd_; }
  void clear() noexcept;

 private:
  int fd_;
};

}  // namespace vernier
