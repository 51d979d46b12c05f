// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/fleet/sparkplug.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// A device's data as received: the machine, the gateway and the data.
struct DeviceData {
  std::string gateway, machine;
  SparkplugPayload payload;
};

/// The last number of a gateway's spool that is in the registry; the registry reports it to the gateway.
struct Receipt {
  std::string spool;
  std::uint64_t stored = 0;
  bool resend = false;  // a record is missing: begin behind `stored`
};

/// Writes samples into the registry, each once. Records of a spool are stored in the order of their numbers.
/// The last number is updated in the same transaction as the records, and earlier records are ignored. Two
/// writers may run at the same time. Only samples of machines that are in the registry are stored. The
/// samples of another machine are counted (Registry::not_entered), and the gateway may forget them.
class SampleWriter {
 public:
  explicit SampleWriter(registry::Registry& registry) : registry_(registry) {}
  /// Receipts by gateway, for all data that were written or must be sent again. Throws DatabaseError: no data
  /// were written.
  std::map<std::string, Receipt> write(const std::vector<DeviceData>& data);
  /// A machine, or all of a gateway's (machine empty), can be heard or not.
  void online(const std::string& gateway, const std::string& machine, bool online);
  /// Returns the number of samples written so far.
  std::uint64_t written() const { return written_; }
  /// Machines that are not in the registry and whose samples write() got, each name once. The list is empty
  /// afterwards.
  std::vector<std::string> take_not_entered();

 private:
  struct Batch;
  struct Cursor {
    std::uint64_t stored = 0;
    std::string gateway;
  };
  Cursor& cursor(const std::string& spool, const std::string& gateway);
  bool take(const DeviceData& one, Batch& batch);
  void count_not_entered(const Batch& batch);
  std::string shape(const SparkplugPayload& payload, Batch& batch);
  void write(Batch& batch);
  void write_live(const Batch& batch);

  registry::Registry& registry_;
  std::map<std::string, Cursor> cursors_;
  std::set<std::string> shapes_, reported_, to_report_;
  std::map<std::string, std::string> faults_;    // by machine: the last one
  std::map<std::string, std::uint64_t> checks_;  // by machine: time of the last one
  std::uint64_t written_ = 0;
};

}  // namespace vernier::fleet
