// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace vernier::diagnose {

// What the search for effects looks at: ranges, steps, folds and numbers of candidates. These numbers are not
// thresholds: a larger range, a finer step or a longer list takes more time and memory, and the levels
// (fit/noise/levels.h) decide about what it adds. `threshold_sweep --search` measures their influence.

/// Values over which the scanned unknowns of the candidate effects are searched.
struct CandidateExtent {
  /// Largest number of products of sines and cosines in a gravity function along the chain, because each tick
  /// of the control computes all products. The gravity function of a seven-joint arm on a tilted base has 30
  /// products.
  std::size_t most_terms_of_gravity = 40;
  /// Range of the searched time constants. The shortest time constant is `time_least_steps` intervals between
  /// rows, or the duration of the rows divided by `time_least_part` if that is longer. The longest is
  /// `time_most` durations. A first-order lag with a shorter or longer time constant looks like a step or a
  /// straight line.
  double time_least_steps = 3, time_least_part = 200, time_most = 3;
  /// Number of time constants in the searched range, on a logarithmic scale: a factor of 1.5 apart. The best
  /// time constant is refined.
  std::size_t time_values = 16;
  /// Largest number of summands of a thermal response. The thermal response of a machine column needs about
  /// ten summands: two walls and four delays of its thermometers, in three directions and by height. Source:
  /// experiment (columns in finite differences: 8 to 10).
  std::size_t most_of_response = 12;
  /// Range of the searched decay lengths: the travel range divided by each of these numbers.
  double travel_least_part = 500, travel_most_part = 2;
  std::size_t travel_values = 14;  // number of decay lengths, a factor of 1.6 apart; the best decay length is
                                   // refined
  /// Periods of the search grid: largest number of periods in the range (a periodogram searches shorter
  /// periods), and number of tested frequencies for each frequency that the range distinguishes.
  /// `longest_period_share`: longest period of the search grid, as a fraction of the range. An error with a
  /// longer period looks like a curve, not like a cyclic error.
  double most_periods = 100, periods_per_range = 2.5, longest_period_share = 0.4;
  /// Longest searched period for a linear axis that was read only at positions with equal intervals, as a
  /// fraction of the range. At equal intervals a short period looks like a long period (aliasing). Six tenths
  /// of a period in the range are not yet a parabola.
  double longest_aliased_share = 1.6;
  /// Integer fractions of one revolution that are always tested as periods: errors of gears and bearings up
  /// to the twelfth order.
  std::size_t harmonics_of_turn = 12;
  /// An approach direction of an axis has its own grid of positions if two limits are exceeded:
  /// `comb_positions`, a number of positions, and `comb_share`, a fraction of the rows.
  std::size_t comb_positions = 6;
  double comb_share = 0.25;
  /// Shortest searched period, in intervals between the measured positions: two intervals by the sampling
  /// theorem, plus a twentieth for intervals that are not quite equal.
  double steps_per_period = 2.1;
  /// Factor by which the fit may move a scanned unknown beyond the limits of its search range.
  double driven_out = 2;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("candidates.most_terms_of_gravity", most_terms_of_gravity);
    visit("candidates.time_least_steps", time_least_steps);
    visit("candidates.time_least_part", time_least_part);
    visit("candidates.time_most", time_most);
    visit("candidates.time_values", time_values);
    visit("candidates.most_of_response", most_of_response);
    visit("candidates.travel_least_part", travel_least_part);
    visit("candidates.travel_most_part", travel_most_part);
    visit("candidates.travel_values", travel_values);
    visit("candidates.most_periods", most_periods);
    visit("candidates.periods_per_range", periods_per_range);
    visit("candidates.longest_period_share", longest_period_share);
    visit("candidates.longest_aliased_share", longest_aliased_share);
    visit("candidates.harmonics_of_turn", harmonics_of_turn);
    visit("candidates.comb_positions", comb_positions);
    visit("candidates.comb_share", comb_share);
    visit("candidates.steps_per_period", steps_per_period);
    visit("candidates.driven_out", driven_out);
  }
};

/// Frequencies of the periodogram, which searches periods shorter than those of the grid.
struct FinePeriodExtent {
  /// Number of tested frequencies for each frequency that the measured range distinguishes. A peak between
  /// two tested frequencies keeps nine tenths of its height.
  double per_range = 3;
  /// Limits of the search for short periods: number of periods in the range, and number of periods for each
  /// measured position. The limit of 1000 periods in the range corresponds to a ball screw of 1 mm lead on an
  /// axis of 1 m. The limit of 80 periods for each position exists because fewer positions per period do not
  /// show the cyclic error. With only twelve positions, the best of a thousand periods explains 80 % of an
  /// unrelated error pattern, and other periods explain as much. A cyclic error that is found with only a few
  /// positions is reported together with its aliases (Scanner::aliases).
  double most_periods = 1000, per_position = 80;
  /// Number of peaks of the periodogram that are evaluated in full for each location. The slowest of the
  /// peaks that fit nearly as well is evaluated too.
  std::size_t peaks = 3;
  /// Smallest number of tested frequencies for which the search for short periods is done.
  double fewest = 4;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("fine.per_range", per_range);
    visit("fine.most_periods", most_periods);
    visit("fine.per_position", per_position);
    visit("fine.peaks", peaks);
    visit("fine.fewest", fewest);
  }
};

/// Candidates that enter the pool.
struct PoolExtent {
  /// Number of values of the search grid that count as one test, because neighbouring values explain nearly
  /// the same.
  double points_per_try = 2.5;
  /// Number of candidates that one scan adds to the pool, and smallest number of candidates for each effect.
  std::size_t most_at_once = 50, of_each_effect = 3;
  /// Change of the BIC above which a candidate's scanned values are refined before the candidate is added to
  /// the pool. A candidate with a smaller change of the BIC never becomes significant.
  double refined_above = -20;
  /// Two periods at one location are different candidates if they differ by more than one part in
  /// `periods_per_e` (here one eighth).
  double periods_per_e = 8;
  /// Number of the best products of recorded quantities that the search multiplies by one more factor.
  std::size_t extended = 25;
  /// Preference for the form nearest to the axis if several forms fit equally well: a difference of the BIC,
  /// far below any evidence.
  double step_of_place = 0.05;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("pool.points_per_try", points_per_try);
    visit("pool.most_at_once", most_at_once);
    visit("pool.of_each_effect", of_each_effect);
    visit("pool.refined_above", refined_above);
    visit("pool.periods_per_e", periods_per_e);
    visit("pool.extended", extended);
    visit("pool.step_of_place", step_of_place);
  }
};

/// Parts of a survey that are held out in turn.
struct FoldExtent {
  /// `blocks_of_one_run`: number of blocks into which a single run is divided. `large_run`: a run with this
  /// fraction of the rows is divided too. `parts_of_run`: an effect of runs is tested on this many parts of
  /// each run.
  std::size_t blocks_of_one_run = 5;
  double large_run = 1.0 / 3;
  std::size_t parts_of_run = 4;
  /// If a quantity has more than `most_levels` levels, it is a sweep and is divided into `parts_of_sweep`
  /// parts.
  std::size_t most_levels = 8, parts_of_sweep = 3;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("folds.blocks_of_one_run", blocks_of_one_run);
    visit("folds.large_run", large_run);
    visit("folds.parts_of_run", parts_of_run);
    visit("folds.most_levels", most_levels);
    visit("folds.parts_of_sweep", parts_of_sweep);
  }
};

/// Functions with which the shape of an effect is compared.
struct ShapeExtent {
  /// Largest and smallest number of half-waves in a smooth curve. An eighth of the range is the shortest
  /// half-wave that a table of 17 stations can correct.
  std::size_t most_half_waves = 8, fewest_half_waves = 3;
  /// Number of positions along the axis at which the test assumes a jump.
  std::size_t places_of_jump = 64;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("shape.most_half_waves", most_half_waves);
    visit("shape.fewest_half_waves", fewest_half_waves);
    visit("shape.places_of_jump", places_of_jump);
  }
};

/// The extent of the search.
struct SearchExtent {
  CandidateExtent candidates;
  FinePeriodExtent fine;
  PoolExtent pool;
  FoldExtent folds;
  ShapeExtent shape;
  /// Largest number of elements of the Jacobian (240 MB). In a long survey with more elements, only every
  /// k-th row is used.
  double most_numbers = 3e7;

  /// Calls visit("concern.name", number) for every number of the extent: double or std::size_t.
  template <class Visit>
  void for_each(const Visit& visit) {
    candidates.for_each(visit);
    fine.for_each(visit);
    pool.for_each(visit);
    folds.for_each(visit);
    shape.for_each(visit);
    visit("most_numbers", most_numbers);
  }
};

// Numerical tolerances: limits between rounding errors and numbers that mean something.

/// Limit for the singular values of the scaled Jacobian, as a fraction of the largest singular value. A fit
/// does not change the parameters along a direction whose singular value is below the limit: such directions
/// are visible only through products of errors.
inline constexpr double kAbsorbCutoff = 1e-4;
/// Smallest response of the readings to a motion at a location in the chain (axis and degree of freedom), as
/// a fraction of the largest response to motions of the same kind. A smaller response is a rounding error, as
/// that of a rotation about an axis through the measured point.
inline constexpr double kRoundingOfResponse = 1e-9;
/// Limit for 1 - cosine of the influences of two locations on all readings. Below it the influences of both
/// locations are equal. The value is sqrt of the rounding error, with three digits of margin.
inline constexpr double kSamePlace = 1e-7;
/// Smallest fraction of a column's squared length that must remain after projection on the orthogonal
/// complement of the columns of a set. A column with a smaller fraction is a linear combination of the set.
inline constexpr double kLeastPivot = 1e-5;
/// Power of the spectral window of the positions, as a fraction of its largest power, above which two periods
/// have equal columns.
inline constexpr double kSameAlias = 0.9999;

}  // namespace vernier::diagnose
