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
  std::string place;   // host, device or interface
  int port = 1502;
  std::map<std::string, std::string> options;

  /// Returns an option as a number (0x for hexadecimal); `otherwise` if the option is absent. Throws
  /// InputError.
  std::uint32_t number(const std::string& name, std::uint32_t otherwise) const;
};

/// Throws InputError naming the word. `HOST:PORT` without a scheme is TCP.
BoardUrl parse_url(const std::string& text);

}  // namespace vernier::upload
