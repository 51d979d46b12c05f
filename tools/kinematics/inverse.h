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

/// Solves the inverse kinematics of all states together by Newton iteration with damping
/// (Levenberg-Marquardt, Marquardt 1963) on the forward kinematics. The position of a rotary axis is changed
/// by whole turns into its range. The returned axis positions themselves are verified by the forward
/// kinematics. `target`: one pose for each state, in workpiece coordinates (for kPosition the rotation is
/// not used). `start`: start values of the axes, and the motion, inputs, runs and time, which are not
/// changed. The Jacobian is computed by central differences. The Jacobian therefore includes every
/// expression of the chain. Throws InputError if the value of the chain is not finite.
InverseResult solve(const model::Machine& machine, const model::Poses& target, const model::States& start,
                    const InverseOptions& options);

/// Solves the inverse kinematics for one pose from several starts: first from `start`, then from up to
/// `restarts` starts over the axis ranges (Halton sequence, equal in every call). The function solve_anywhere
/// returns the first solution within the ranges, or the best attempt if there is no solution. Axes without
/// min and max always begin at their value in `start`.
InverseResult solve_anywhere(const model::Machine& machine, const model::Poses& target,
                             const model::States& start, const InverseOptions& options, int restarts);

/// Returns the indices of the linear axes of the machine, in their order.
std::vector<std::size_t> linear_axes(const model::Machine& machine);

}  // namespace vernier::kinematics
