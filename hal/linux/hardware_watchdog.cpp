// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/hardware_watchdog.h"

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vernier {

std::unique_ptr<HardwareWatchdog> HardwareWatchdog::open(const std::string& device, int seconds,
                                                         std::string& error) {
  const int fd = ::open(device.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) {
    error = device + ": " + std::strerror(errno);
    return nullptr;
  }
  // A driver with a fixed time keeps it.
  [[maybe_unused]] const int unused = ::ioctl(fd, WDIOC_SETTIMEOUT, &seconds);
  return std::unique_ptr<HardwareWatchdog>(new HardwareWatchdog(fd));
}

HardwareWatchdog::~HardwareWatchdog() { ::close(fd_); }

void HardwareWatchdog::feed() noexcept { [[maybe_unused]] const auto unused = ::write(fd_, "\n", 1); }

// The letter that marks an intended end (Documentation/watchdog/watchdog-api.rst, "magic close").
void HardwareWatchdog::disarm() noexcept { [[maybe_unused]] const auto unused = ::write(fd_, "V", 1); }

}  // namespace vernier
