// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Reports the state of the daemon to the service manager of the operating system, with the datagram protocol
/// of systemd (sd_notify(3)). If no service manager started the process, nothing is sent. ServiceManager
/// never waits. A message that cannot be sent immediately is dropped.
class ServiceManager {
 public:
  /// Reads the address of the service manager from the environment variable NOTIFY_SOCKET. Not real-time
  /// safe.
  ServiceManager() noexcept;
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// `state`: for example "READY=1", "WATCHDOG=1", "STOPPING=1". Returns false if there is a service manager
  /// and the message could not be sent. Not real-time safe.
  bool notify(const char* state) noexcept;

 private:
  int fd_ = -1;
  bool asked_ = false;
};

}  // namespace vernier
