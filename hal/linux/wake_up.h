// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"

namespace vernier {

/// Wakes a thread that waits in wait() or in a poll() of the handle. If wake() is called before the wait
/// begins, the wait ends immediately.
class WakeUp {
 public:
  /// The constructor never throws. If the operating system has no more handles, a wait ends only when its
  /// time is over. Not real-time safe.
  WakeUp() noexcept;
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void wake() noexcept;
  /// Waits for a wake-up for at most `wait`, and clears the wake-up. Not real-time safe.
  void wait(TimeUs wait) noexcept;
  /// Returns the handle for poll(). After poll(), call clear() to clear the wake-up.
  int handle() const noexcept { return fd_; }
  void clear() noexcept;

 private:
  int fd_;
};

}  // namespace vernier
