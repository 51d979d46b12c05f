// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/registry/registry.h"
#include "tools/text/error.h"

namespace vernier::registry {

/// Another caller has the lock of a machine: no further step on the machine is allowed.
class LockLost : public text::LimitNotMet {
 public:
  using text::LimitNotMet::LimitNotMet;
};

/// Locks of machines in the registry: only one caller at a time works on a machine, from any computer. A lock
/// is a lease by the database's clock. The holder renews the lease. The lease of a killed caller ends by
/// itself; then the next caller can lock the machine.
class MachineLocks {
 public:
  /// Locks all machines, or no machine. purpose: text for users, e.g. "rollout spring". lease_s: 1 s at
  /// least. Throws LimitNotMet naming the machine that another caller has locked, and the latest end of that
  /// lock.
  MachineLocks(Registry& registry, std::vector<std::string> machines, std::string purpose, double lease_s);
  /// Releases the machines that are still locked.
  ~MachineLocks();
  MachineLocks(const MachineLocks&) = delete;
  MachineLocks& operator=(const MachineLocks&) = delete;

  /// Renews the leases when a third of a lease has passed. Throws LockLost if a lease has ended or another
  /// caller has locked the machine.
  void renew();
  /// Renews the leases immediately; call it right before a step that cannot be undone. Throws LockLost like
  /// renew().
  void require();
  /// The owner of the lock, for statements that are executed only while the lock is held.
  const std::string& holder() const { return holder_; }

 private:
  Registry& registry_;
  std::vector<std::string> machines_;
  std::string holder_;
  double lease_s_;
  std::int64_t renewed_us_ = 0;  // by this computer's steady clock
};

}  // namespace vernier::registry
