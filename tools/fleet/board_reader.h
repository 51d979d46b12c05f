// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/fleet/gateway_file.h"
#include "tools/fleet/sparkplug.h"
#include "tools/upload/client.h"

namespace vernier::fleet {

/// Reads one board and returns its values as metrics.
class BoardReader {
 public:
  /// Opens the board. Throws InputError if the board is not available, LimitNotMet if it is not the requested
  /// board.
  explicit BoardReader(const GatewayBoard& board);
  /// Present state of the board: names of tools/docs/fleet.md. Throws as upload::Client.
  std::vector<Metric> read();

 private:
  void read_check(std::vector<Metric>& metrics);

  GatewayBoard board_;
  upload::Client client_;
  std::optional<std::filesystem::file_time_type> check_time_;
  std::vector<Metric> check_;
};

/// The metrics of a file that `vernier check --json` wrote at time_us; empty for another file.
std::vector<Metric> check_metrics(const std::string& json, std::int64_t time_us);

}  // namespace vernier::fleet
