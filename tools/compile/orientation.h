// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "tools/compile/walk.h"
#include "tools/model/states.h"

namespace vernier::compile {

/// Correction of the tool's direction by the rotary axes. The graph is that of the derivation.
struct Tilting {
  std::size_t frozen_from = 0;  // steps of the chain before the frame of Orientation::deviation
  /// Returns the motion of each of Orientation::axes, deg, that changes the direction by v. v: in the frame
  /// of Orientation. so_far: motion to which the new motion is added (empty: 0). The damping limits the sum
  /// of so_far and the new motion, not each of them.
  std::function<std::vector<NodeId>(Graph&, const NodeVector& v, const std::vector<NodeId>& so_far)> solve;
};

/// Selects one or two rotary axes that tilt the tool. solve_direction selects the pair of axes whose tilts
/// over the declared ranges are farthest from parallel. Among equal pairs, solve_direction selects the pair
/// nearer to the tool. solve_direction solves the deviation of the tool's direction for the selected axes and
/// enters derivation.orientation. Damped least squares: near a pose in which both axes tilt the tool in the
/// same direction, the component of the correction that these axes cannot reach decreases to 0; the other
/// component remains (Nakamura and Hanafusa, ASME J. Dyn. Sys. 108 (1986) 163). Returns nullopt if no rotary
/// axis tilts the tool. neglect: rad.
std::optional<Tilting> solve_direction(const model::Machine& machine, Derivation& derivation, double neglect);

/// Returns a value as a separate node that is limited to +-limit. A correction that depends on the limited
/// value then uses the actual motion of the axis.
NodeId held_within(Graph& graph, NodeId value, double limit);

/// For each state: true if two axes tilt the tool in nearly the same direction at this state, so that the
/// correction of the tool direction is damped. All values are false if no direction is corrected.
std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states);

}  // namespace vernier::compile
