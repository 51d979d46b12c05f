// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace vernier::fit {

// All thresholds for the noise of readings: unit, meaning, source. "Experiment" is the sweep of
// tools/docs/thresholds.md: halved and doubled over surveys of known truth.

/// Thresholds for the decision which rows are repeated readings of one pose.
struct LayoutThresholds {
  /// Steps between rows below this share of an axis' range may be at the same pose. The value is the
  /// repeatability of a drive relative to its travel.
  double small_step = 1e-2;
  /// Factor between the largest false step and the smallest real step. Experiment: poses read to 2
  /// um.
  double pose_gap = 20;
  /// Share of a range below which a step is rounding.
  double no_step = 1e-9;

  /// Share of the rows that must return to a position before distances of neighbours are divided
  /// into small and large ones. Some random positions are near each other by chance.
  double least_revisits = 0.1;
  /// Factor between small and large distances of neighbours. For random positions, successive sorted
  /// distances have a ratio below 1.5, except for a few.
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

/// Evidence that is required to report correlated errors of readings.
struct NoiseThresholds {
  /// Required decrease of -2 log likelihood for a component with one parameter on its boundary: a tail
  /// probability of chi^2 of 1e-3. Self and Liang 1987.
  double one_component = 9.5;
  /// Required decrease of -2 log likelihood for a drift, which has two parameters.
  double drift_component = 13;
  /// Penalty for the row of a step, in units of the logarithm of the number of readings. The height of a step
  /// counts 1 in addition, in each kind of reading. Experiment: surveys with low noise.
  double price_of_place = 2;
  /// For rows without a standard uncertainty u: share of the residual below which the independent noise is
  /// negligible. A residual with less independent noise is smooth and not noise.
  double least_own_part = 0.02;
  /// Number of readings beyond the parameters below which noise counts as independent. With fewer
  /// readings the uncertainty of a variance exceeds a quarter (sqrt(2/30)).
  std::size_t least_freedom = 30;
  /// Minimum number of rows on either side of a step of the instrument. With fewer rows a step cannot be
  /// distinguished from their noise.
  std::size_t rows_beside_step = 10;
  /// Share of the effect of a step on its rows that must remain after projection on the complement of the
  /// free parameters.
  double own_of_step = 0.02;
  /// Limit of a reading in robust standard deviations. A single outlier is not a property of the
  /// noise.
  double held = 4;
  /// Readings that scatter by less than this share of u are much better than stated. In this case u is the
  /// standard deviation of the independent noise.
  double near_u = 0.7;
  /// Readings that scatter by less than this share of u have negligible noise: they come from a simulation.
  double far_below_u = 0.01;
  /// Largest number of instrument steps that are searched. More steps are a drift.
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
