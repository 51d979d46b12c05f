// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "tools/compile/walk.h"
#include "tools/model/states.h"

namespace vernier::compile {

/// Correction of the tool's direction by the rotary axes of a machine. The functions of Tilting use the graph
/// of the derivation.
struct Tilting {
  std::size_t frozen_from = 0;  // number of steps of the chain before the frame of Orientation::deviation
  /// Returns the motion of each of Orientation::axes, deg, that changes the direction of the tool by v. v:
  /// change of the direction, in the frame of Orientation. so_far: motion to which the returned motion is
  /// added; empty: 0. The damping limits the sum of `so_far` and the returned motion, not each of them.
  std::function<std::vector<NodeId>(Graph&, const NodeVector& v, const std::vector<NodeId>& so_far)> solve;
};

/// Selects one or two rotary axes that tilt the tool. The function solve_direction selects the pair of axes
/// whose tilt directions over the declared ranges are farthest from parallel. Among equal pairs, the pair
/// nearer to the tool is selected. For the selected axes, solve_direction solves the deviation of the tool's
/// direction and stores derivation.orientation. The method is damped least squares (Nakamura and Hanafusa,
/// ASME J. Dyn. Sys. 108 (1986) 163). Near a pose in which both axes tilt the tool in the same direction, the
/// component of the correction that the axes cannot reach decreases to 0. The component of the correction
/// that the axes can reach remains. Returns nullopt if no rotary axis of the machine tilts the tool.
/// `neglect`: limit for omitted terms, rad.
std::optional<Tilting> solve_direction(const model::Machine& machine, Derivation& derivation, double neglect);

/// Returns a node with the value of `value`, limited to +-limit. A correction that is computed from the
/// returned node, and not from `value`, allows for the limited motion of the axis.
NodeId held_within(Graph& graph, NodeId value, double limit);

/// Returns one flag for each state: true if two axes tilt the tool in nearly the same direction, so that the
/// correction of the tool direction is damped. All flags are false if the machine does not correct the
/// direction of the tool.
std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states);

}  // namespace vernier::compile
