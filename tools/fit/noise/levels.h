// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstddef>

namespace vernier::fit {

/// The levels: all numbers that were chosen and that decide an answer of `fit` (noise of readings) and of
/// `diagnose`. Every threshold of both is one of the levels, or is computed from one. Each level has its
/// meaning and its source. A level without a published source has its influence measured: the page
/// tools/docs/thresholds.md has the changed results of a sweep at half and at twice each level. The extent of
/// a search (diagnose/propose/search_extent.h) and numerical tolerances decide nothing: a larger search or a
/// smaller tolerance only takes longer.
struct Levels {
  // Odds and chances.

  /// Odds at which evidence is strong: 20 to 1, a difference of 2 ln 20 = 6 in the BIC (Kass and Raftery
  /// 1995). The same odds make a cause a member of the list of possible causes, and are the e-value of a step
  /// on held-out rows (Ville's inequality: a false step reaches 20 in at most one case of twenty).
  double strong_odds = 20;
  /// Odds at which evidence is very strong: 150 to 1, a difference of 10 in the BIC (Kass and Raftery 1995).
  double very_strong_odds = 150;
  /// Significance level of a test that is done once in a diagnosis. At this level a survey without an error
  /// has a false finding in one case of a thousand per test.
  double chance = 1e-3;
  /// Significance level of a test that is done for every effect, or for many columns.
  double chance_of_many = 1e-4;
  /// Chance to reject a true effect: one in a hundred (normal distribution: 2.33 standard deviations).
  double chance_of_loss = 1e-2;

  // Standard deviations.

  /// Standard deviations of chi^2 beyond which a residual is not noise. A normal distribution exceeds 4
  /// standard deviations once in 30 000 cases. A larger reading does not enter an estimate of noise in full
  /// (Huber 1981).
  double sigmas = 4;
  /// Standard deviations beyond which a reading is an outlier: once in 5e8 readings.
  double outlier_sigmas = 6;
  /// Factor by which u may be wrong. GUM (E.4.3): the standard uncertainty of a standard uncertainty from
  /// few readings is a fraction of it; 1.4 is that of three readings (52 %).
  double doubtful_u = std::sqrt(2.0);
  /// Factor by which u is never wrong.
  double implausible_u = 3;

  // Counts of readings.

  /// Number of degrees of freedom below which a variance is only a guess: its relative standard deviation is
  /// above 45 %, sqrt(2/10).
  double few_readings = 10;
  /// Number of degrees of freedom from which a variance can be compared: its relative standard deviation is
  /// 26 %, sqrt(2/30).
  std::size_t enough_readings = 30;
  /// Number of degrees of freedom from which a residual shows whether it has structure. Source: experiment
  /// with errors outside the catalogue. With one reading per row, 160 rows do not show the structure of the
  /// residual, and 400 rows do.
  double readings_of_structure = 300;
  /// Readings for each coefficient of a table. With fewer, a table follows the noise of single readings.
  double readings_per_coefficient = 4;

  // Shares.

  /// Share of an effect that no survey can show: a thousandth of 100 um is the noise of an interferometer.
  double invisible = 1e-3;
  /// Share that does not count: of a noise, of a range, of a sum of squares.
  double negligible = 0.02;
  /// Small share, such as the rest that a name may leave at its location.
  double small = 0.05;
  /// Share by which two things may differ and still be alike.
  double alike = 0.1;
  /// Share below which a part is a minor part, or above which (1 - minor) it is nearly all.
  double minor = 0.2;
  /// Share from which a part is the larger part.
  double most = 0.5;
  /// Share of a large majority.
  double majority = 0.75;

  // Numbers of things.

  /// Largest number of functions of one axis that are separate causes at one location. More are likely pieces
  /// of one function.
  std::size_t functions_of_axis = 2;
  /// Largest number of functions of position, or of cyclic errors, that are separate causes.
  std::size_t functions_of_position = 3;
  /// Largest number of steps of the instrument, or of changed runs. More can describe any drift.
  std::size_t most_steps = 4;
  /// Number of periods that are needed to know a cyclic error from a curve, and of positions in each period
  /// (sampling theorem).
  double periods = 2;
  /// Row intervals below which a drift is not a drift of an instrument, which changes slowly.
  double rows_of_a_drift = 3;
  /// Factor between two groups of distances: repeated positions and others. The ratio of successive sorted
  /// distances of random positions is below 1.5, except for a few.
  double gap = 3;
  /// The same factor for the steps between successive rows, which differ more: a pose is read to micrometres,
  /// and the next pose is millimetres away.
  double pose_gap = 20;
  /// Difference of a temperature, in degC, from which a survey shows the effects of heat. Smaller differences
  /// are as large as the errors of thermometers.
  double warmth_degC = 1;

  /// Difference of the BIC or of -2 log likelihood at strong and at very strong odds.
  double strong() const { return 2 * std::log(strong_odds); }
  double very_strong() const { return 2 * std::log(very_strong_odds); }

  /// Calls visit("level", number) for every level. The type of a level is double or std::size_t.
  template <class Visit>
  void for_each(const Visit& visit) {
    visit("strong_odds", strong_odds);
    visit("very_strong_odds", very_strong_odds);
    visit("chance", chance);
    visit("chance_of_many", chance_of_many);
    visit("chance_of_loss", chance_of_loss);
    visit("sigmas", sigmas);
    visit("outlier_sigmas", outlier_sigmas);
    visit("doubtful_u", doubtful_u);
    visit("implausible_u", implausible_u);
    visit("few_readings", few_readings);
    visit("enough_readings", enough_readings);
    visit("readings_of_structure", readings_of_structure);
    visit("readings_per_coefficient", readings_per_coefficient);
    visit("invisible", invisible);
    visit("negligible", negligible);
    visit("small", small);
    visit("alike", alike);
    visit("minor", minor);
    visit("most", most);
    visit("majority", majority);
    visit("functions_of_axis", functions_of_axis);
    visit("functions_of_position", functions_of_position);
    visit("most_steps", most_steps);
    visit("periods", periods);
    visit("rows_of_a_drift", rows_of_a_drift);
    visit("gap", gap);
    visit("pose_gap", pose_gap);
    visit("warmth_degC", warmth_degC);
  }
};

}  // namespace vernier::fit
