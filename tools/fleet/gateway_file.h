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
  std::string board;  // the name that the board must have; empty: any
  std::string check;  // file of `vernier check --json`; empty: none
};

/// Settings of a gateway (TOML; tools/docs/fleet.md).
struct GatewayFile {
  std::string name, group = "vernier", host = "vernier", store;
  Broker broker;
  double period_s = 1;
  std::uint64_t most_records = 5'000'000;
  std::vector<GatewayBoard> boards;
};

/// Throws InputError with file, line and word. Relative paths in the gateway file refer to the folder of the
/// file.
GatewayFile parse_gateway_file(const std::string& text, const std::string& path);

}  // namespace vernier::fleet
