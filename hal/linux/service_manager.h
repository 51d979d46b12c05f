// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Tells the service manager how the daemon does, by the datagram protocol of systemd (sd_notify(3)); does
/// nothing where none asked. state: "READY=1", "WATCHDOG=1", "STOPPING=1". False where it was asked for and
/// failed. setup.
bool notify_service_manager(const char* state) noexcept;

}  // namespace vernier
