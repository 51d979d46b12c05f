// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace vernier::fit {

// Every number by which the noise of readings is judged: unit, meaning, source. "Experiment" is the sweep of
// tools/docs/thresholds.md: halved and doubled over surveys of known truth.

/// Which rows are one pose read again.
struct LayoutThresholds {
  /// Steps between rows below this share of an axis' range may be the same pose. Stands for the repeatability
  /// of a drive beside its travel.
  double small_step = 1e-2;
  /// Factor between the largest step that is none and the least real one. Experiment: poses read to 2 um.
  double pose_gap = 20;
  /// Share of a range below which a step is rounding.
  double no_step = 1e-9;

  /// Share of the rows that has to come back to a place before distances of neighbours are divided into
  /// small and large ones: of positions at random a few are close by chance.
  double least_revisits = 0.1;
  /// Factor between the two. Of positions at random neighbours in the order of distances, but for those few,
  /// are within 1.5 of each other.
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

/// The evidence that it takes to call errors of readings correlated.
struct NoiseThresholds {
  /// Fall of -2 log likelihood at which a component of one parameter on its boundary is no chance: a tail of
  /// chi^2 of 1e-3. Self and Liang 1987.
  double one_component = 9.5;
  /// The same for a drift, which has two.
  double drift_component = 13;
  /// Price of a step's place among all rows, in units of the logarithm of the readings, beside 1 for its
  /// height in each kind of reading. Experiment: quiet surveys.
  double price_of_place = 2;
  /// Share of the rest below which, without u, a reading's own part is next to nothing: what is left is
  /// smooth and no noise.
  double least_own_part = 0.02;
  /// Readings beyond the parameters below which noise counts as independent: of fewer a variance is known to
  /// no better than a quarter (sqrt(2/30)).
  std::size_t least_freedom = 30;
  /// Rows on either side of a step of the instrument: fewer show none beside their own noise.
  std::size_t rows_beside_step = 10;
  /// Share of a step's rows that the model may not be able to take over.
  double own_of_step = 0.02;
  /// Robust spreads at which a reading is held: one wild reading is no property of the noise.
  double held = 4;
  /// Readings that scatter by less than this share of u are far better than it says: u counts as their own.
  double near_u = 0.7;
  /// Readings that scatter by less than this share of u have no noise to speak of: simulated ones.
  double far_below_u = 0.01;
  /// Steps of the instrument that are looked for. More of them are a drift.
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
