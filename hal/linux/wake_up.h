// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"

namespace vernier {

/// Wakes a thread that waits in wait() or in a poll() of its handle. A wake-up before the wait ends the wait
/// immediately.
class WakeUp {
 public:
  /// Never throws: if the system has no more handles, waits end by their time alone. setup.
  WakeUp() noexcept;
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void wake() noexcept;
  /// At most `wait`; takes the wake-up. setup.
  void wait(TimeUs wait) noexcept;
  /// The handle for poll(), and the function that clears the wake-up after it.
  int handle() const noexcept { return fd_; }
  void clear() noexcept;

 private:
  int fd_;
};

}  // namespace vernier
