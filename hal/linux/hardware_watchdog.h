// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

namespace vernier {

/// A hardware watchdog of the Linux kernel (/dev/watchdog). The watchdog resets the computer if the daemon
/// does not trigger the watchdog within its time.
class HardwareWatchdog {
 public:
  /// Starts the watchdog immediately. The time of the watchdog is set to `seconds` if the driver supports
  /// this. Returns null, and the reason in `error`, if the watchdog cannot be opened. Not real-time safe.
  static std::unique_ptr<HardwareWatchdog> open(const std::string& device, int seconds, std::string& error);
  /// If disarm() was not called before the destructor, the watchdog resets the computer when its time is
  /// over.
  ~HardwareWatchdog();
  HardwareWatchdog(const HardwareWatchdog&) = delete;
  HardwareWatchdog& operator=(const HardwareWatchdog&) = delete;

  void feed() noexcept;
  /// Stops the watchdog at an orderly end of the program, if the driver supports this. Not real-time safe.
  void disarm() noexcept;

 private:
  explicit HardwareWatchdog(int fd) noexcept : fd_(fd) {}
  int fd_;
};

}  // namespace vernier
