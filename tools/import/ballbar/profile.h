// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

inline constexpr Eigen::Index kProfilePoints = 720;  // of a turn, half a degree each

/// Returns the mean reading of a run with a clock by angle (from +A towards +B), um: kProfilePoints values,
/// all turns on the circle together, without centre and radius. Angles without a reading are interpolated.
Eigen::VectorXd angle_profile(const BallbarRun& run);

/// Shift between two profiles.
struct ProfileShift {
  double deg = 0;              // of `second` against `first`, -90..90
  double correlation = 0;      // at that shift, smoothed over 10 deg
  double uncertainty_deg = 0;  // half the width in which the correlation is not significantly less
};
ProfileShift profile_shift(const Eigen::VectorXd& first, const Eigen::VectorXd& second);

}  // namespace vernier::importer
