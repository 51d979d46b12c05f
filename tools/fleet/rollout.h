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

/// Result of one call of roll_out.
struct RolloutEnd {
  std::string stood;                // why the rollout stopped; empty: every machine keeps its image
  std::set<std::string> in_effect;  // machines that had their image in effect at the last look of this call
  std::vector<std::string> notes;   // items that were not proved, one sentence each
};

/// Distributes correction images to boards in stages. Each image first runs on trial. The rollout checks that
/// the board uses the image, the judge command evaluates the machine, and then the image is confirmed. Before
/// data are signed or sent, a board proves that it is the board of the machine (RolloutMachine::claim). If
/// the registry has no key and the board has one, the key is entered in the registry (trust on first use) and
/// reported. All machines are locked in the registry for the whole call. Machines in the state kept are
/// checked when the call begins, before each stage and at the end. The rollout stops, and a machine loses the
/// state kept, if its board does not answer, is another board, or does not use the image. At the first
/// machine that is worse, or whose result is not known, the image of this machine is reverted. The rollout
/// stops until a user allows it to continue. The registry records the steps: an interrupted rollout continues
/// where it stopped. A board whose trial is not confirmed returns to its previous image by itself. kept:
/// called for each machine whose image was confirmed. Throws LimitNotMet if another caller has locked one of
/// the machines; then no step was done.
RolloutEnd roll_out(registry::Registry& registry, std::vector<RolloutMachine> machines,
                    const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
                    const std::function<void(const RolloutMachine&)>& kept);

/// Converts "1,10%,100%" to the position (from 1) of the last machine of each stage. Throws InputError.
std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines);

}  // namespace vernier::fleet
