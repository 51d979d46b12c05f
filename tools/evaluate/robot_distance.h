// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// Results of ISO 9283:1998, 7.3 for the distance between two poses. mm; a rotation about an axis in deg.
struct DistanceResult {
  Eigen::Vector3d from_mm, to_mm;  // commanded
  std::size_t count = 0;           // of distances
  double commanded_mm = 0;         // D_c
  double accuracy_mm = 0;          // AD = mean distance - D_c
  double accuracy_std_mm = 0;      // of it: scatter of the mean, and u of the instrument at either pose
  double repeatability_mm = 0;     // RD = 3 S of the distances, n - 1
  double low_mm = 0, high_mm = 0;  // 95 % interval of RD
  Eigen::Vector3d accuracy_xyz_mm,
      repeatability_xyz_mm;  // AD_x y z and RD_x y z: of the distances along each
};

/// Returns the distances between each pose and the next pose, in the order of their first visit (two poses:
/// one distance). The first visits are compared, then the second visits, and so on: D_j = |P1_j - P2_j|,
/// along an axis |x1_j - x2_j|; AD = mean of D_j - D_c, RD = 3 sqrt(sum of (D_j - mean)^2 / (n - 1)). Throws
/// InputError: fewer than two poses or visits, poses that are not visited equally often. Source: ISO
/// 9283:1998, 7.3.2, 7.3.3. AD has a sign: a positive AD is a too long distance. The interval assumes normal
/// distances.
std::vector<DistanceResult> evaluate_distances(const std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
