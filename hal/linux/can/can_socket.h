// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <linux/can.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vernier {

/// Returns an identifier as the kernel writes it: 11 bits; above 0x7ff, 29 bits with their flag.
canid_t can_identifier(std::uint32_t id) noexcept;

/// Binds a socket to an interface ("can0"). address: the other fields of the address (identifiers of ISO-TP).
/// Closes the socket and sets `error` if that fails. Not real-time safe.
bool bind_can(int socket, const std::string& interface, sockaddr_can address, std::string& error);

/// Opens a non-blocking socket for frames with these identifiers. bus_errors: the kernel also reports the
/// bus-off state. An interface with a '/' is the path of a local socket (SOCK_SEQPACKET) of a program in the
/// place of a bus: the first message has the filters (can_filter), the others are frames (can_frame). A
/// program also receives each of its own frames if its filters contain the identifier of the frame. Returns
/// -1 with `error` set if the kernel refuses. Not real-time safe.
int open_can(const std::string& interface, const std::vector<std::uint32_t>& ids, bool bus_errors,
             std::string& error);

/// The socket also gets the frames that it sends itself, in their order on the bus. Closes the socket and
/// sets `error` if the kernel refuses. Not real-time safe.
bool hear_own_frames(int socket, const std::string& interface, std::string& error);

/// Sets `error` to the last error of the system ("can0: no such interface: ..."), closes the socket and
/// returns -1. Not real-time safe.
int can_failed(const std::string& interface, const char* what, int socket, std::string& error);

}  // namespace vernier
