// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/kinematics/types.h"
#include "tools/model/chain.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::kinematics {

const char* name_of(InverseFault fault);

/// Newton iteration with damping (Levenberg-Marquardt, Marquardt 1963) on the forward solution, for all
/// states at once. A rotary axis is turned by whole turns into its range; the proof is of what is returned.
/// `target`: one pose a state, workpiece coordinates (rotation unused for kPosition).
/// `start`: first guess, and motion, inputs, runs and time as they are. Jacobian by central differences, so
/// that every expression of the chain counts. Throws InputError where the chain is not finite. tool.
InverseResult solve(const model::Machine& machine, const model::Poses& target, const model::States& start,
                    const InverseOptions& options);

/// The same for one pose from many places: `start` first, then up to `restarts` starts spread over the axis
/// ranges (Halton sequence, the same every time). The first solution within the ranges, else the best
/// failure. Axes without min and max keep their start. tool.
InverseResult solve_anywhere(const model::Machine& machine, const model::Poses& target,
                             const model::States& start, const InverseOptions& options, int restarts);

/// Axes of `machine` that are linear, in order.
std::vector<std::size_t> linear_axes(const model::Machine& machine);

}  // namespace vernier::kinematics
