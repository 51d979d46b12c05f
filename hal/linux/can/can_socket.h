// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <linux/can.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vernier {

/// Returns an identifier in the form of the kernel: 11 bits; above 0x7ff, 29 bits with a flag.
canid_t can_identifier(std::uint32_t id) noexcept;

/// Binds a socket to a CAN interface ("can0"). `address`: the other fields of the address (identifiers of
/// ISO-TP). If the bind fails, the function closes the socket and sets `error`. Not real-time safe.
bool bind_can(int socket, const std::string& interface, sockaddr_can address, std::string& error);

/// Opens a non-blocking socket for frames with the identifiers `ids`. `bus_errors`: true if the kernel also
/// reports the bus-off state. If the name of the interface contains a '/', it is the path of a local socket
/// (SOCK_SEQPACKET) of a program that replaces the bus. The first message contains the filters (can_filter),
/// and the other messages are frames (can_frame). A program also receives each of its own frames if its
/// filters contain the identifier of the frame. If the kernel refuses, the function returns -1 and sets
/// `error`. Not real-time safe.
int open_can(const std::string& interface, const std::vector<std::uint32_t>& ids, bool bus_errors,
             std::string& error);

/// Sets the socket so that it also receives the frames that it sends, in their order on the bus. If the
/// kernel refuses, the function closes the socket and sets `error`. Not real-time safe.
bool hear_own_frames(int socket, const std::string& interface, std::string& error);

/// Sets `error` to the last error of the operating system ("can0: no such interface: ..."), closes the socket
/// and returns -1. Not real-time safe.
int can_failed(const std::string& interface, const char* what, int socket, std::string& error);

}  // namespace vernier
