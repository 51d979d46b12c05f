// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

namespace vernier {

/// A watchdog of the kernel (/dev/watchdog): it resets the computer if it is not fed within its time.
class HardwareWatchdog {
 public:
  /// Starts the watchdog immediately, with a time of `seconds` if the driver allows to set it. Null with
  /// `error` set if it cannot be opened. setup.
  static std::unique_ptr<HardwareWatchdog> open(const std::string& device, int seconds, std::string& error);
  /// Without disarm() the computer is reset when its time is over.
  ~HardwareWatchdog();
  HardwareWatchdog(const HardwareWatchdog&) = delete;
  HardwareWatchdog& operator=(const HardwareWatchdog&) = delete;

  void feed() noexcept;
  /// An orderly end: the watchdog stops if the driver allows it. setup.
  void disarm() noexcept;

 private:
  explicit HardwareWatchdog(int fd) noexcept : fd_(fd) {}
  int fd_;
};

}  // namespace vernier
