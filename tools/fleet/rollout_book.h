// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/registry/machine_lock.h"
#include "tools/registry/registry.h"
#include "tools/upload/client.h"

namespace vernier::fleet {

/// A machine of a rollout. The machines are in the order of the rollout.
struct RolloutMachine {
  std::string name, url;
  upload::BoardClaim claim;  // required identity of the board; at least a name
  std::vector<std::uint8_t> image;
  std::int64_t stage = 0;
};
/// Returns the fingerprint of the image for a machine.
std::uint64_t fingerprint_of(const RolloutMachine& machine);

/// State of one machine in a rollout.
struct RolloutState {
  std::string machine;
  std::string state;  // "waiting", "trial", "kept", "taken-back", "refused", "not-in-effect" or "away"
  std::string said;   // reason for this state
  std::string image;  // fingerprint of the image, 16 hexadecimal digits
  std::int64_t stage = 0, at_us = 0;
  std::uint64_t issued = 0;  // signing time of the last trial in this rollout; 0: no trial
};

/// The rows of one rollout in the registry. The rows are written only while the caller has the lock of the
/// machine. All functions of RolloutBook can throw DatabaseError; functions that write can also throw
/// LockLost.
class RolloutBook {
 public:
  RolloutBook(registry::Registry& registry, std::string name, const registry::MachineLocks& locks)
      : registry_(registry), name_(std::move(name)), locks_(locks) {}
  void enter(const std::vector<RolloutMachine>& machines);
  void write(const RolloutMachine& machine, const char* state, const std::string& said);
  /// Records that the trial of a machine begins. `issued`: signing time, by which the board identifies the
  /// trial.
  void begin_trial(const RolloutMachine& machine, std::uint64_t issued);
  /// Records that machines whose image was reverted are tried again.
  void allow();

 private:
  void run(const std::string& set, const std::string& machine, std::vector<registry::Cell> values);
  registry::Registry& registry_;
  std::string name_;
  const registry::MachineLocks& locks_;
};

/// Returns the states of the machines in the order of the rollout. The list of machine states is empty if no
/// rollout has the given name.
std::vector<RolloutState> rollout_states(registry::Registry& registry, const std::string& name);

}  // namespace vernier::fleet
