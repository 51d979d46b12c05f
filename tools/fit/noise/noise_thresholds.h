// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/fit/noise/levels.h"

namespace vernier::fit {

// The thresholds for the noise of readings. Each has its unit, its meaning and the level from which it is
// computed (levels.h).

/// Thresholds for the decision which rows are repeated readings of one pose.
struct LayoutThresholds {
  Levels levels{};
  /// Limit for a step between rows, as a share of the range of an axis. Rows with a smaller step may be at
  /// the same pose.
  double small_step = levels.negligible;
  /// Factor between the largest step within a pose and the smallest step between two poses.
  double pose_gap = levels.pose_gap;
  /// Share of the rows that must return to an earlier position. The distances between neighbouring positions
  /// are divided into small and large distances only if enough rows return to an earlier position. The limit
  /// is necessary because some random positions are near each other by chance.
  double least_revisits = levels.alike;
  /// Factor between the small and the large distances of neighbouring positions.
  double revisit_gap = levels.gap;
};

/// Limit for a step between rows, as a share of the range of an axis. A step between rows below this limit is
/// rounding error.
inline constexpr double kNoStep = 1e-9;

/// Penalty for the row at which a step of the instrument begins, in units of the logarithm of the number of
/// readings. The height of a step adds a penalty of 1 in each kind of reading. Source: the modified BIC of
/// Zhang and Siegmund 2007 has a penalty of 3 for the place and the height of a step.
inline constexpr double kPriceOfPlace = 2;

/// Thresholds for the evidence that is required to report correlated errors of readings.
struct NoiseThresholds {
  Levels levels{};
  /// Significance level of a noise component: a common error of the readings of a pose or of a run, or a
  /// drift.
  double chance = levels.chance;
  /// For rows without a standard uncertainty u: share of the residual below which the independent noise is
  /// negligible. If the independent noise is below this share, the residual is smooth and is not noise.
  double least_own_part = levels.negligible;
  /// Smallest number of degrees of freedom (readings minus parameters) for an estimate of correlated noise.
  /// With fewer degrees of freedom, the noise counts as independent.
  std::size_t least_freedom = levels.enough_readings;
  /// Smallest number of rows before and after a step of the instrument. With fewer rows, a step of the
  /// instrument cannot be distinguished from the noise of these rows.
  std::size_t rows_beside_step = static_cast<std::size_t>(levels.few_readings);
  /// Smallest share of a step's effect on the readings that must remain after projection on the orthogonal
  /// complement of the free parameters.
  double own_of_step = levels.negligible;
  /// Limit for a reading, in robust standard deviations. Larger readings are reduced to the limit before the
  /// noise is estimated. The limit exists because a single outlier is not a property of the noise.
  double held = levels.sigmas;
  /// Limit for the scatter of the readings as a share of u. Readings with less scatter have negligible noise,
  /// because they come from a simulation.
  double far_below_u = levels.negligible;
  /// Largest number of steps of the instrument in a noise model. An error with more steps counts as a drift.
  std::size_t most_steps = levels.most_steps;
};

}  // namespace vernier::fit
