// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/maths/alignment.h"

namespace vernier::maths {

/// A robot pose and the pose that an instrument measured there: seen = place * pose * mounting. `place` is
/// one unknown rigid motion for each group. `mounting` is one unknown rigid motion for all groups. All
/// lengths are in mm.
struct SeenPose {
  RigidMotion pose, seen;
  std::size_t group = 0;
};

RigidMotion operator*(const RigidMotion& first, const RigidMotion& second);
RigidMotion inverse_of(const RigidMotion& motion);

/// Returns the mounting in closed form from the relative motions between poses of one group (A X = X B). The
/// rotation aligns the axes of these motions (Park and Martin, IEEE Trans. Robotics and Automation 10 (1994)
/// 717), with the vectors 2 sin(angle / 2) of Tsai and Lenz (same journal 5 (1989) 345), which have no
/// singularity below 180 deg. The translation is a linear least-squares solution. The function mounting_of()
/// returns nullopt if all rotations are about one axis, because they do not determine the mounting.
std::optional<RigidMotion> mounting_of(const std::vector<SeenPose>& poses);

/// Returns the rigid motion `place` of one group: the mean of seen * (pose * mounting)^-1 over its poses.
/// `poses`: one or more poses of the group.
RigidMotion place_of(const std::vector<SeenPose>& poses, const RigidMotion& mounting);

}  // namespace vernier::maths
