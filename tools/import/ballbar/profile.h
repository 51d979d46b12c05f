// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

inline constexpr Eigen::Index kProfilePoints = 720;  // number of points of one turn, at a distance of half a
                                                     // degree

/// Returns the mean reading of a run as a function of the angle (from +A towards +B), um. The kProfilePoints
/// values combine all turns on the circle, without the least-squares centre and radius. The run must have a
/// clock. At angles without a reading, the mean reading is interpolated.
Eigen::VectorXd angle_profile(const BallbarRun& run);

/// Angular shift between the profiles of two runs.
struct ProfileShift {
  double deg = 0;              // shift of `second` relative to `first`, -90..90
  double correlation = 0;      // correlation at this shift, of profiles that are smoothed over 10 deg
  double uncertainty_deg = 0;  // half the width of the range of shifts in which the correlation is not
                               // significantly smaller
};
ProfileShift profile_shift(const Eigen::VectorXd& first, const Eigen::VectorXd& second);

}  // namespace vernier::importer
