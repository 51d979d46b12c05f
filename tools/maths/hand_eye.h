// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/maths/alignment.h"

namespace vernier::maths {

/// A robot pose and what an instrument saw there: seen = place * pose * mounting. `place` is one unknown
/// motion for each group, `mounting` is one unknown motion for all. Lengths in mm.
struct SeenPose {
  RigidMotion pose, seen;
  std::size_t group = 0;
};

RigidMotion operator*(const RigidMotion& first, const RigidMotion& second);
RigidMotion inverse_of(const RigidMotion& motion);

/// Returns the mounting in closed form from the relative motions of poses of one group (A X = X B): the
/// rotation brings the axes of the motions together (Park and Martin, IEEE Trans. Robotics and Automation 10
/// (1994) 717, with the vectors 2 sin(angle / 2) of Tsai and Lenz, same journal 5 (1989) 345, which have no
/// singularity below 180 deg); the translation is linear least squares. nullopt: the rotations are about one
/// axis only, and do not determine the mounting.
std::optional<RigidMotion> mounting_of(const std::vector<SeenPose>& poses);

/// Returns the place of one group: the mean of seen * (pose * mounting)^-1. poses: one or more.
RigidMotion place_of(const std::vector<SeenPose>& poses, const RigidMotion& mounting);

}  // namespace vernier::maths
