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

/// Result of one call of roll_out().
struct RolloutEnd {
  std::string stood;                // reason why the rollout stopped; empty: every machine keeps its image
  std::set<std::string> in_effect;  // machines that used their image at the last check of this call
  std::vector<std::string> notes;   // items that were not proved, one sentence for each
};

/// Distributes correction images to the boards of a fleet in stages. On each board the image first runs on
/// trial. The rollout checks that the board uses the image, and the judge command evaluates the machine.
/// After these checks, the image is confirmed. Before data are signed or sent, a board must prove that it is
/// the board of the machine (RolloutMachine::claim). If the registry has no key for a board that has a key,
/// this key is entered in the registry (trust on first use) and reported. All machines are locked in the
/// registry during the whole call. Machines in the state `kept` are checked at the beginning of the call,
/// before each stage and at the end. If the board of a machine in the state `kept` does not answer, is
/// another board, or does not use the image, the rollout stops and the machine loses the state `kept`. At the
/// first machine that is worse, or whose evaluation gives no result, the image of this machine is reverted.
/// After a reverted image, the rollout stops until a user allows it to continue. The registry contains the
/// completed steps. An interrupted rollout therefore continues where it stopped. A board whose trial is not
/// confirmed returns to its previous image without a command. `kept`: function that is called for each
/// machine whose image was confirmed. Throws LimitNotMet if another caller has locked one of the machines. If
/// one of the machines is locked, no step of the rollout is done.
RolloutEnd roll_out(registry::Registry& registry, std::vector<RolloutMachine> machines,
                    const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
                    const std::function<void(const RolloutMachine&)>& kept);

/// Converts the stages "1,10%,100%" to the number (from 1) of the last machine in each stage. Throws
/// InputError if the text is not a list of stages.
std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines);

}  // namespace vernier::fleet
