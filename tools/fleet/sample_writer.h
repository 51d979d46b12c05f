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

/// Data of a device as received: the machine, the gateway and the payload.
struct DeviceData {
  std::string gateway, machine;
  SparkplugPayload payload;
};

/// Receipt for a gateway: the last number of its spool that is stored in the registry.
struct Receipt {
  std::string spool;
  std::uint64_t stored = 0;
  bool resend = false;  // true: a record is missing, and the gateway must send again from the record after
                        // `stored`
};

/// Writes samples to the registry, each sample once. The records of a spool are stored in the order of their
/// numbers. The last number is updated in the same transaction as the records. A record whose number is not
/// above the last stored number is ignored. Two SampleWriter objects may write to one registry at the same
/// time. Only samples of machines that are in the registry are stored. The samples of an unknown machine are
/// counted (Registry::not_entered), and the gateway may delete them.
class SampleWriter {
 public:
  explicit SampleWriter(registry::Registry& registry) : registry_(registry) {}
  /// Writes data and returns the receipts by gateway, for all data that were written or must be sent again.
  /// If the function throws DatabaseError, no data were written.
  std::map<std::string, Receipt> write(const std::vector<DeviceData>& data);
  /// Records whether a machine is connected. If `machine` is empty, the function records the connection
  /// state of all machines of the gateway.
  void online(const std::string& gateway, const std::string& machine, bool online);
  /// Returns the number of samples that were written.
  std::uint64_t written() const { return written_; }
  /// Returns the machines that are not in the registry and for which write() received samples, each name
  /// once. The call of take_not_entered() empties the list of machines that are not in the registry.
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
  std::map<std::string, std::string> faults_;    // last fault of each machine
  std::map<std::string, std::uint64_t> checks_;  // time of the last check of each machine
  std::uint64_t written_ = 0;
};

}  // namespace vernier::fleet
