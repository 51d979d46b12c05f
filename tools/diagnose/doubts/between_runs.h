// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Changes of the machine between the runs that explain the readings as well as an accepted effect does.
struct ChangeBetweenRuns {
  bool sizes = false;  // the same error with another size in each run
  bool step = false;   // the same error with one step from a run on; only for an effect of an input
};

/// Compares one of the accepted effects `items` with a change between the runs: the same error with another
/// size in each run, or with one step, for example a squareness after a collision. A change can be confused
/// only with an effect that an input or the time drives, and only if this changes much more between the runs
/// than within a run: a slow response to heat that begins again in each run, or a temperature that steps with
/// the machine. The test compares the BIC of the effect, together with all such effects that move the
/// readings in the same way, and of the change, each in a model with the other accepted effects. The BIC of
/// the change may be larger by less than `distance`.
ChangeBetweenRuns change_between_runs(const Evidence& evidence, const Pool& pool,
                                      const std::vector<std::size_t>& items, std::size_t position,
                                      double distance);

}  // namespace vernier::diagnose
