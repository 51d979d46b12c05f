// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Reports the state of the daemon to the service manager, by the datagram protocol of systemd
/// (sd_notify(3)); no action if no service manager requested it. It never waits: a message without room is
/// dropped.
class ServiceManager {
 public:
  /// Its address is in NOTIFY_SOCKET. setup.
  ServiceManager() noexcept;
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// state: "READY=1", "WATCHDOG=1", "STOPPING=1". False if it was requested and failed. setup.
  bool notify(const char* state) noexcept;

 private:
  int fd_ = -1;
  bool asked_ = false;
};

}  // namespace vernier
