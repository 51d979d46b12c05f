// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tools/fleet/gateway.h"
#include "tools/fleet/image_trial.h"
#include "tools/fleet/rollout_book.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// How a call ended.
struct RolloutEnd {
  std::string stood;                // why the rollout stands; empty: every machine keeps its image
  std::set<std::string> in_effect;  // machines that had their image in effect at the last look of this call
  std::vector<std::string> notes;   // what was not proved, a sentence each
};

/// Brings images to boards by stages: each on trial first, watched to be in effect, judged, then kept. Before
/// anything is signed or sent a board proves that it is the machine's (RolloutMachine::claim); where no key
/// is entered and the board has one, that key is entered in the registry (trust on first use) and said. All
/// machines are locked in the registry for the whole call. Kept machines are looked at when the call begins,
/// before each stage and at the end: one that does not answer, is another board or does not have its image in
/// effect stops the rollout and is not called kept any more. At the first machine that is worse, or of which
/// that is not known, its image is taken back and the rollout stands until somebody allows it to go on. What
/// was done stands in the registry: a rollout that was interrupted goes on where it was, and a board whose
/// trial nobody confirms goes back by itself. kept: called for each machine that was kept. Throws LimitNotMet
/// where another caller has one of the machines; nothing was done then. tool.
RolloutEnd roll_out(registry::Registry& registry, std::vector<RolloutMachine> machines,
                    const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
                    const std::function<void(const RolloutMachine&)>& kept);

/// "1,10%,100%" as the last place (1 on) of each stage among so many machines. Throws InputError. tool.
std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines);

}  // namespace vernier::fleet
