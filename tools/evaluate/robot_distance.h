// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// Results of ISO 9283:1998, 7.3 for the distance between two poses, mm.
struct DistanceResult {
  Eigen::Vector3d from_mm, to_mm;  // commanded positions
  std::size_t count = 0;           // number of distances
  double commanded_mm = 0;         // D_c: commanded distance
  double accuracy_mm = 0;          // AD: mean distance minus D_c
  double accuracy_std_mm = 0;      // standard uncertainty of AD: scatter of the mean, and u of the instrument
                                   // at both poses
  double repeatability_mm = 0;     // RD: 3 times the standard deviation of the distances (n - 1)
  double low_mm = 0, high_mm = 0;  // ends of the 95 % interval of RD
  Eigen::Vector3d accuracy_xyz_mm,
      repeatability_xyz_mm;  // AD_x y z and RD_x y z, from the distances along each coordinate
};

/// Returns the results for the distance between each pose and the next pose, in the order of their first
/// visit. (Two poses have one distance.) The first visits of both poses are compared, then their second
/// visits, and so on: D_j = |P1_j - P2_j|, along an axis |x1_j - x2_j|. The results are AD = mean of D_j -
/// D_c and RD = 3 sqrt(sum of (D_j - mean)^2 / (n - 1)). Throws InputError if there are fewer than two poses
/// or visits, or if the poses are not visited equally often. The definitions are those of ISO 9283:1998,
/// 7.3.2 and 7.3.3. A positive AD means that the distance is too long. The interval of RD is valid for
/// normally distributed distances.
std::vector<DistanceResult> evaluate_distances(const std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
