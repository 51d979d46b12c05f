// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "firmware/daemon/settings/board_file.h"

namespace vernier {

/// Returns the numeric IPv4 address `address` of a Modbus device. Throws BoardError if `address` is a name,
/// another spelling of a number, or an address that no device can have (0.0.0.0, broadcast). Not real-time
/// safe.
const std::string& modbus_address(const SignalSource& source);

/// Returns the numeric IPv4 address `address` to which a link listens (127.0.0.1), or 0.0.0.0 for all
/// addresses of the board. Throws BoardError if the address is not valid. Not real-time safe.
std::string listening_address(const SignalSource& source);

/// True if the Modbus device is on a serial line (setting `device`) and not at a network address. Not
/// real-time safe.
inline bool is_serial(const SignalSource& source) { return source.texts.contains("device"); }

/// Returns the path of the serial line `device`. A symbolic link (/dev/serial/by-id) gives the path to which
/// it points. Throws BoardError if the setting is not valid. Not real-time safe.
std::string serial_line(const SignalSource& source);

/// Returns the name of a serial line, or of a TCP peer (`device`, or `address` and `port`). All spellings of
/// one line or peer give the same name. Throws BoardError if the settings are not valid. Not real-time safe.
std::string modbus_peer(const SignalSource& source);

/// Returns a text that is equal for all outputs with the same block of registers: peer, unit and first
/// register. Throws BoardError if the settings are not valid. Not real-time safe.
std::string modbus_block(const SignalSource& source);

/// Checks that different uses of the registers of one Modbus device do not conflict. All registers of a peer
/// and unit are one address space. A block of `modbus-out` must have no register in common with another
/// block, an echo, or a holding register that an input reads. An echo must not belong to two blocks. A serial
/// line over which the board writes a block of registers must have no other use in the board file. If two
/// uses conflict, throws BoardError with the lines of both settings. Not real-time safe.
void refuse_shared_registers(const BoardFile& board);

}  // namespace vernier
