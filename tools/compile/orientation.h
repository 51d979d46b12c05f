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
  /// Motion of each of Orientation::axes, deg, that has the effect v on the direction; v in that
  /// frame. so_far: the motion to which it is added (empty: 0). The damping then limits their sum,
  /// not each alone.
  std::function<std::vector<NodeId>(Graph&, const NodeVector& v, const std::vector<NodeId>& so_far)> solve;
};

/// Selects one or two rotary axes that tilt the tool. Of all pairs it takes the two whose tilts
/// over the declared ranges are farthest from parallel. If pairs are equal, it takes the pair
/// nearer to the tool. It solves the deviation of the tool's direction for them and enters
/// derivation.orientation. Damped least squares: towards a pose in which the axes tilt the tool in
/// the same direction, the component that they cannot reach decreases to 0, the component that
/// they can reach remains (Nakamura and Hanafusa, ASME J. Dyn. Sys. 108 (1986) 163). Returns
/// nullopt if no rotary axis tilts the tool. neglect: rad. tool.
std::optional<Tilting> solve_direction(const model::Machine& machine, Derivation& derivation, double neglect);

/// Returns a value as a separate node that is limited to +-limit. A correction that depends on it
/// then uses the actual motion of the axis.
NodeId held_within(Graph& graph, NodeId value, double limit);

/// For each state: do two axes tilt the tool in nearly the same direction there, so that the
/// correction of its direction is damped? All false if no direction is corrected. tool.
std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states);

}  // namespace vernier::compile
