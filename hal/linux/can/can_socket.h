// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <linux/can.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vernier {

/// An identifier as the kernel writes it: 11 bits, or 29 with their flag above 0x7ff.
canid_t can_identifier(std::uint32_t id) noexcept;

/// Binds a socket to an interface ("can0"). address: its other fields (identifiers of ISO-TP). Closes the
/// socket and sets `error` if that fails. setup.
bool bind_can(int socket, const std::string& interface, sockaddr_can address, std::string& error);

/// A non-blocking socket for frames with these identifiers. bus_errors: the kernel also reports the bus-off
/// state. -1 with `error` set if the kernel refuses. setup.
int open_can(const std::string& interface, const std::vector<std::uint32_t>& ids, bool bus_errors,
             std::string& error);

/// "can0: no such interface: ..." of the last error of the system; closes the socket. -1. setup.
int can_failed(const std::string& interface, const char* what, int socket, std::string& error);

}  // namespace vernier
