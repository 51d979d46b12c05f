// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace vernier::fit {

// All thresholds for the noise of readings, each with its unit, meaning and source. The source "experiment"
// is the sweep of tools/docs/thresholds.md: each threshold was halved and doubled over surveys with a known
// error.

/// Thresholds for the decision which rows are repeated readings of one pose.
struct LayoutThresholds {
  /// Limit for a step between rows, as a share of the range of an axis. Rows with a smaller step may be at
  /// the same pose. The value 0.01 represents the repeatability of a drive relative to its travel.
  double small_step = 1e-2;
  /// Factor between the largest step within a pose and the smallest step between two poses. Source:
  /// experiment with poses that were read to 2 um.
  double pose_gap = 20;
  /// Limit for a step between rows, as a share of the range of an axis. A step between rows below this limit
  /// is rounding error.
  double no_step = 1e-9;

  /// Share of the rows that must return to an earlier position. The distances between neighbouring positions
  /// are divided into small and large distances only if enough rows return to an earlier position. The limit
  /// is necessary because some random positions are near each other by chance.
  double least_revisits = 0.1;
  /// Factor between the small and the large distances of neighbouring positions. Source: for random
  /// positions, the ratio of successive sorted distances is below 1.5, except for a few distances.
  double revisit_gap = 3;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("layout.least_revisits", least_revisits);
    visit("layout.revisit_gap", revisit_gap);
    visit("layout.small_step", small_step);
    visit("layout.pose_gap", pose_gap);
    visit("layout.no_step", no_step);
  }
};

/// Thresholds for the evidence that is required to report correlated errors of readings.
struct NoiseThresholds {
  /// Decrease of -2 log likelihood that is required for a noise component with one parameter on the boundary
  /// of its range. At the required decrease, the tail probability of chi^2 is 1e-3. Source of this test at
  /// the boundary: Self and Liang 1987.
  double one_component = 9.5;
  /// Decrease of -2 log likelihood that is required for a drift, because a drift has two parameters.
  double drift_component = 13;
  /// Penalty for the row at which a step of the instrument begins, in units of the logarithm of the number of
  /// readings. The height of a step adds a penalty of 1 in each kind of reading. Source: experiment with
  /// surveys of low noise.
  double price_of_place = 2;
  /// For rows without a standard uncertainty u: share of the residual below which the independent noise is
  /// negligible. If the independent noise is below this share, the residual is smooth and is not noise.
  double least_own_part = 0.02;
  /// Smallest number of degrees of freedom (readings minus parameters) for an estimate of correlated noise.
  /// With fewer degrees of freedom, the noise counts as independent. With fewer than 30 degrees of freedom,
  /// the relative uncertainty of a variance exceeds a quarter (sqrt(2/30)).
  std::size_t least_freedom = 30;
  /// Smallest number of rows before and after a step of the instrument. With fewer rows, a step of the
  /// instrument cannot be distinguished from the noise of these rows.
  std::size_t rows_beside_step = 10;
  /// Smallest share of a step's effect on the readings that must remain after projection on the orthogonal
  /// complement of the free parameters.
  double own_of_step = 0.02;
  /// Limit for a reading, in robust standard deviations. Larger readings are reduced to the limit before the
  /// noise is estimated. The limit exists because a single outlier is not a property of the noise.
  double held = 4;
  /// Limit for the scatter of the readings as a share of u. Readings with less scatter are much better than
  /// the stated u. If the scatter of the readings is much smaller than u, u is used as the standard deviation
  /// of the independent noise.
  double near_u = 0.7;
  /// Limit for the scatter of the readings as a share of u. Readings with less scatter have negligible noise,
  /// because they come from a simulation.
  double far_below_u = 0.01;
  /// Largest number of steps of the instrument in a noise model. An error with more than four steps counts as
  /// a drift.
  std::size_t most_steps = 4;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("noise.one_component", one_component);
    visit("noise.drift_component", drift_component);
    visit("noise.price_of_place", price_of_place);
    visit("noise.least_own_part", least_own_part);
    visit("noise.least_freedom", least_freedom);
    visit("noise.rows_beside_step", rows_beside_step);
    visit("noise.own_of_step", own_of_step);
    visit("noise.held", held);
    visit("noise.near_u", near_u);
    visit("noise.far_below_u", far_below_u);
    visit("noise.most_steps", most_steps);
  }
};

}  // namespace vernier::fit
