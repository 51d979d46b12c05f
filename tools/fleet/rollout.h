// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/fleet/gateway.h"
#include "tools/registry/registry.h"
#include "tools/upload/client.h"

namespace vernier::fleet {

/// A machine of a rollout, in its order.
struct RolloutMachine {
  std::string name, url;
  std::vector<std::uint8_t> image;
  std::int64_t stage = 0;
};

/// Where a machine stands in a rollout.
struct RolloutState {
  std::string machine, state, said, image;  // "waiting", "trial", "kept", "taken-back", "away"
  std::int64_t stage = 0, at_us = 0;
};

struct RolloutOptions {
  std::string name;
  upload::SigningKey key;
  double watch_s = 10;  // on trial, before it is judged
  std::string judge;    // a shell's command: 0 not worse, anything else worse or not known; empty: only the
                        // board is watched
};

/// Brings images to boards by stages: each on trial first, watched, judged, then kept. Before a stage all
/// machines of the stages before are looked at again. At the first machine that is worse, or of which that is
/// not known, its image is taken back and the rollout stands until somebody allows it to go on. What was done
/// stands in the registry: a rollout that was interrupted goes on where it was, and a board whose trial
/// nobody confirms goes back by itself. kept: called for each machine that was kept. Throws LimitNotMet with
/// the machine and why where it stopped. tool.
void roll_out(registry::Registry& registry, const std::vector<RolloutMachine>& machines,
              const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
              const std::function<void(const RolloutMachine&)>& kept);

/// In the rollout's order; empty where there is none of that name.
std::vector<RolloutState> rollout_states(registry::Registry& registry, const std::string& name);
/// A rollout that stopped may go on: machines that were taken back are tried again.
void allow_rollout(registry::Registry& registry, const std::string& name);

/// "1,10%,100%" as the last place (1 on) of each stage among so many machines. Throws InputError. tool.
std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines);

}  // namespace vernier::fleet
