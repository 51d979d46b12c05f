// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// True if the same error with another size in each run, for example a squareness after a collision, explains
/// the readings as well as one of the accepted effects `items` does. A change between the runs can be
/// confused only with an effect that an input or the time drives, and only if this changes much more between
/// the runs than within a run: a slow response to heat that begins again in each run. The test compares the
/// BIC of the effect, together with all such effects that move the readings in the same way, and of the
/// change, each in a model with the other accepted effects. The BIC of the change may be larger by less than
/// `distance`.
bool sizes_of_runs_explain(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t position, double distance);

/// As sizes_of_runs_explain(), for the same error with one step from a row on, alone or beside a constant
/// size, and for an effect of an input only: a temperature or a load that steps as the machine does. The step
/// is at the begin of a run, or at the row within a run at which an input of the effect steps.
bool one_step_explains(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t position, double distance);

}  // namespace vernier::diagnose
