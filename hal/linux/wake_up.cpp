// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/wake_up.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

namespace vernier {

WakeUp::WakeUp() noexcept : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

WakeUp::~WakeUp() {
  if (fd_ >= 0) ::close(fd_);
}

void WakeUp::wake() noexcept {
  // A counter that is full wakes as well.
  [[maybe_unused]] const int unused = ::eventfd_write(fd_, 1);
}

void WakeUp::clear() noexcept {
  eventfd_t count = 0;
  [[maybe_unused]] const int unused = ::eventfd_read(fd_, &count);
}

void WakeUp::wait(TimeUs wait) noexcept {
  pollfd waiting{fd_, POLLIN, 0};
  if (::poll(&waiting, 1, static_cast<int>(wait.count / 1000)) > 0) clear();
}

}  // namespace vernier
