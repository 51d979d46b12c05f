// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/registry/registry.h"
#include "tools/text/error.h"

namespace vernier::registry {

/// Exception: another caller has the lock of a machine, so that no further step on this machine is permitted.
class LockLost : public text::LimitNotMet {
 public:
  using text::LimitNotMet::LimitNotMet;
};

/// Locks of machines in the registry. Only one caller at a time may work on a machine, from any computer. A
/// lock is a lease: it ends after a time by the clock of the database. The owner of a lock renews its lease.
/// If the owner is killed, its lease ends, and then another caller can lock the machine.
class MachineLocks {
 public:
  /// Locks all of the machines, or none of them if one cannot be locked. `purpose`: text for users, for
  /// example "rollout spring". `lease_s`: duration of the lease, at least 1 s. Throws LimitNotMet with the
  /// name of a machine that another caller has locked, and the latest end of that lock.
  MachineLocks(Registry& registry, std::vector<std::string> machines, std::string purpose, double lease_s);
  /// The destructor releases the locks of the machines that this object still holds.
  ~MachineLocks();
  MachineLocks(const MachineLocks&) = delete;
  MachineLocks& operator=(const MachineLocks&) = delete;

  /// Renews the leases if a third of their duration has passed. Throws LockLost if a lease has ended or
  /// another caller has locked the machine.
  void renew();
  /// Renews the leases immediately. Call require() directly before a step that cannot be undone. Throws
  /// LockLost under the same conditions as renew().
  void require();
  /// Returns the id of the lock's owner, for statements that may be executed only while the lock is held.
  const std::string& holder() const { return holder_; }

 private:
  Registry& registry_;
  std::vector<std::string> machines_;
  std::string holder_;
  double lease_s_;
  std::int64_t renewed_us_ = 0;  // time of the last renewal by the steady clock of this computer
};

}  // namespace vernier::registry
