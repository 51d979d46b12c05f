// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/kinematics/types.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::kinematics {

const char* name_of(InverseFault fault);

/// Newton iteration with damping (Levenberg-Marquardt, Marquardt 1963) on the forward kinematics, for all
/// states together. A rotary axis is moved by whole turns into its range. The verification applies to the
/// returned values. `target`: one pose per state, workpiece coordinates (rotation unused for kPosition).
/// `start`: first guess, and unchanged motion, inputs, runs and time. The Jacobian is computed by central
/// differences and therefore includes every expression of the chain. Throws InputError if the chain is not
/// finite.
InverseResult solve(const model::Machine& machine, const model::Poses& target, const model::States& start,
                    const InverseOptions& options);

/// Solves for one pose from many starts: `start` first, then up to `restarts` starts distributed over the
/// axis ranges (Halton sequence, equal in every call). solve_anywhere returns the first solution within the
/// ranges, else the best failure. Axes without min and max keep their start value.
InverseResult solve_anywhere(const model::Machine& machine, const model::Poses& target,
                             const model::States& start, const InverseOptions& options, int restarts);

/// Returns the linear axes of `machine`, in order.
std::vector<std::size_t> linear_axes(const model::Machine& machine);

}  // namespace vernier::kinematics
