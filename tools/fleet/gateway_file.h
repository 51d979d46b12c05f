// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/fleet/mqtt.h"

namespace vernier::fleet {

/// A machine whose board a gateway reads.
struct GatewayBoard {
  std::string machine, url;
  std::string board;  // name that the board must have; empty: any name
  std::string check;  // file that `vernier check --json` writes; empty: no file
};

/// Settings of a gateway (TOML; tools/docs/fleet.md).
struct GatewayFile {
  std::string name, group = "vernier", host = "vernier", store;
  Broker broker;
  double period_s = 1;
  std::uint64_t most_records = 5'000'000;
  std::vector<GatewayBoard> boards;
};

/// Reads the settings of a gateway. Throws InputError with file, line and word if they are not valid.
/// Relative paths in the gateway file are relative to the folder of this file.
GatewayFile parse_gateway_file(const std::string& text, const std::string& path);

}  // namespace vernier::fleet
