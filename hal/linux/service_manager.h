// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Tells the service manager how the daemon does, by the datagram protocol of systemd (sd_notify(3)); does
/// nothing where none asked. It never waits: a message that finds no room is dropped.
class ServiceManager {
 public:
  /// Where it listens stands in NOTIFY_SOCKET. setup.
  ServiceManager() noexcept;
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// state: "READY=1", "WATCHDOG=1", "STOPPING=1". False where it was asked for and failed. setup.
  bool notify(const char* state) noexcept;

 private:
  int fd_ = -1;
  bool asked_ = false;
};

}  // namespace vernier
