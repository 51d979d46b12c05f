// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/registry/machine_lock.h"
#include "tools/registry/registry.h"
#include "tools/upload/client.h"

namespace vernier::fleet {

/// A machine of a rollout; the machines are in the order of the rollout.
struct RolloutMachine {
  std::string name, url;
  upload::BoardClaim claim;  // required identity of its board; a name at least
  std::vector<std::uint8_t> image;
  std::int64_t stage = 0;
};
/// Returns the fingerprint of the image of a machine.
std::uint64_t fingerprint_of(const RolloutMachine& machine);

/// State of a machine in a rollout.
struct RolloutState {
  std::string machine;
  std::string state;  // "waiting", "trial", "kept", "taken-back", "refused", "not-in-effect", "away"
  std::string said;   // why
  std::string image;  // fingerprint, 16 hexadecimal digits
  std::int64_t stage = 0, at_us = 0;
  std::uint64_t issued = 0;  // time of signing of the last trial of this rollout; 0: no trial
};

/// A rollout's rows of the registry. The rows are written only while the caller has the lock of the machine.
/// All calls of RolloutBook throw DatabaseError; calls that write throw LockLost.
class RolloutBook {
 public:
  RolloutBook(registry::Registry& registry, std::string name, const registry::MachineLocks& locks)
      : registry_(registry), name_(std::move(name)), locks_(locks) {}
  void enter(const std::vector<RolloutMachine>& machines);
  void write(const RolloutMachine& machine, const char* state, const std::string& said);
  /// Records that a trial begins. issued: time of signing, by which the board identifies the trial.
  void begin_trial(const RolloutMachine& machine, std::uint64_t issued);
  /// Machines whose image was reverted are tried again.
  void allow();

 private:
  void run(const std::string& set, const std::string& machine, std::vector<registry::Cell> values);
  registry::Registry& registry_;
  std::string name_;
  const registry::MachineLocks& locks_;
};

/// Returns the states of the machines in the order of the rollout; empty if no rollout has this name.
std::vector<RolloutState> rollout_states(registry::Registry& registry, const std::string& name);

}  // namespace vernier::fleet
