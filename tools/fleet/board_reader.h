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

/// Reads the state of one board and returns its values as metrics.
class BoardReader {
 public:
  /// Opens the connection to the board. Throws InputError if the board is not available, and LimitNotMet if
  /// it is not the requested board.
  explicit BoardReader(const GatewayBoard& board);
  /// Reads the present state of the board. The names of the metrics are in tools/docs/fleet.md. Throws the
  /// exceptions of upload::Client.
  std::vector<Metric> read();

 private:
  void read_check(std::vector<Metric>& metrics);

  GatewayBoard board_;
  upload::Client client_;
  std::optional<std::filesystem::file_time_type> check_time_;
  std::vector<Metric> check_;
};

/// Returns the metrics of a file that `vernier check --json` wrote at the time `time_us`; empty if the file
/// has other content.
std::vector<Metric> check_metrics(const std::string& json, std::int64_t time_us);

}  // namespace vernier::fleet
