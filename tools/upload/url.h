// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace vernier::upload {

/// Address of a board: `tcp://HOST[:PORT]`, `rtu://DEVICE[?baud=..&parity=..&unit=..]`,
/// `can://INTERFACE?send=ID&receive=ID`, `serial://DEVICE[?baud=..]`.
struct BoardUrl {
  std::string scheme;  // "tcp", "rtu", "can", "serial"
  std::string place;   // host name, device or interface of the connection
  int port = 1502;
  std::map<std::string, std::string> options;

  /// Returns an option of the address as a number (0x for hexadecimal); `otherwise` if the option is absent.
  /// Throws InputError if the option is not a number.
  std::uint32_t number(const std::string& name, std::uint32_t otherwise) const;
};

/// Reads the address of a board; throws InputError with the wrong word. An address `HOST:PORT` without a
/// scheme is a TCP address.
BoardUrl parse_url(const std::string& text);

}  // namespace vernier::upload
