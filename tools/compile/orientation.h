// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "tools/compile/walk.h"
#include "tools/model/states.h"

namespace vernier::compile {

/// How the rotary axes turn the direction of the tool back. The graph is that of the derivation.
struct Tilting {
  std::size_t frozen_from = 0;  // steps of the chain in front of the frame of Orientation::deviation
  /// Motion of each of Orientation::axes, deg, that has the effect v on the direction; v in that frame.
  /// so_far: the motion to which it is added (none: 0), so that the damping holds their sum small, not each
  /// alone.
  std::function<std::vector<NodeId>(Graph&, const NodeVector& v, const std::vector<NodeId>& so_far)> solve;
};

/// Chooses one or two rotary axes that tilt the tool, the two that are farthest from parallel tilts over the
/// declared ranges, nearer to the tool where that is the same; solves the deviation of the tool's direction
/// for them and enters derivation.orientation. Damped least squares: towards a pose in which the axes tilt
/// the tool the same way, what they cannot reach fades, what they can reach stays (Nakamura and Hanafusa,
/// ASME J. Dyn. Sys. 108 (1986) 163). Nothing where no rotary axis tilts the tool. neglect: rad. tool.
std::optional<Tilting> solve_direction(const model::Machine& machine, Derivation& derivation, double neglect);

/// A value as a node of its own that stays within +-limit: what is corrected elsewhere with it is corrected
/// for what the axis does.
NodeId held_within(Graph& graph, NodeId value, double limit);

/// Of each state: does it stand where two axes tilt the tool nearly the same way, so that the correction of
/// its direction is damped? All false where no direction is corrected. tool.
std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states);

}  // namespace vernier::compile
