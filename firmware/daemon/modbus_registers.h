// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "firmware/daemon/settings/board_file.h"

namespace vernier {

/// Returns the numeric IPv4 address `address` of a Modbus device. Throws BoardError for a name, for another
/// spelling of a number, and for an address that no device can have (0.0.0.0, broadcast). Not real-time safe.
const std::string& modbus_address(const SignalSource& source);

/// Returns the numeric IPv4 address `address` on which a link listens (127.0.0.1), or 0.0.0.0 for all
/// addresses of the board. Throws BoardError. Not real-time safe.
std::string listening_address(const SignalSource& source);

/// True if the device is on a serial line (`device`), not at an address. Not real-time safe.
inline bool is_serial(const SignalSource& source) { return source.texts.contains("device"); }

/// Returns the path of the serial line `device`, the same for a link to it (/dev/serial/by-id). Throws
/// BoardError. Not real-time safe.
std::string serial_line(const SignalSource& source);

/// Returns a serial line, or a peer over TCP (`device` or `address` and `port`), under one name for all its
/// spellings. Throws BoardError. Not real-time safe.
std::string modbus_peer(const SignalSource& source);

/// Returns a text that is the same for all outputs that share one block of registers: peer, unit and first
/// register. Throws BoardError. Not real-time safe.
std::string modbus_block(const SignalSource& source);

/// Refuses a board file in which two uses of the registers of one Modbus device exclude each other. The
/// registers of a peer and unit are one space: a block of `modbus-out` shares no register with another block,
/// with an echo or with a holding register that an input reads, and no echo serves two blocks. A serial line
/// that writes a block has no other use. Throws BoardError with the lines of both settings.
/// Not real-time safe.
void refuse_shared_registers(const BoardFile& board);

}  // namespace vernier
