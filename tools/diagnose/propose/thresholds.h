// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/fit/noise/noise_thresholds.h"

namespace vernier::diagnose {

// All thresholds of a diagnosis: numbers that were chosen and could have another value. One struct per
// subject, each number with its unit, meaning and source. "Experiment" without a name is the sweep of
// tools/docs/thresholds.md: halved and doubled over surveys of known truth. Purely numerical constants
// (rounds until convergence, sections of a golden search, columns in a batch) are defined where they are
// used.

/// Assumptions about the data before any candidate is tested.
struct EvidenceThresholds {
  /// Limit of the scaled Jacobian, as a share of its largest direction: a fit does not follow a weaker
  /// direction. Weaker directions are visible only through products of errors. Experiment: chains with
  /// station tables, whose spectrum has a gap at this value.
  double absorb_cutoff = 1e-4;
  /// If the Jacobian has more numbers than this (240 MB), only every k-th row is used. The limit is for long
  /// surveys.
  double most_numbers = 3e7;
  /// Significance level at which readings of one pose are assumed to share an error (analysis of
  /// variance). Searle 1992.
  double pose_chance = 1e-3;
  /// Degrees of freedom between and within poses that the test for a shared pose error requires. With fewer
  /// degrees of freedom, the uncertainty of the variance exceeds 45 % (sqrt(2/10)).
  double pose_freedom = 10;
  /// Steps of an axis are even if they are multiples of the smallest step, to within this share of the
  /// smallest step. The value represents the positioning accuracy relative to the step of a measurement.
  double even_step = 0.05;
  /// Response of the readings to a motion at a location in the chain (axis and degree of freedom), as a share
  /// of the largest response to motions of the same kind. A response below this share is only rounding.
  /// Example: a rotation about an axis through the read point.
  double rounding = 1e-9;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("evidence.absorb_cutoff", absorb_cutoff);
    visit("evidence.most_numbers", most_numbers);
    visit("evidence.pose_chance", pose_chance);
    visit("evidence.pose_freedom", pose_freedom);
    visit("evidence.even_step", even_step);
    visit("evidence.rounding", rounding);
  }
};

/// Thresholds for the candidates, and for the values over which their unknowns are searched.
struct CandidateThresholds {
  /// Share of a unit vector, on average over the rows, that must be along gravity (a length) or across
  /// gravity (an axis of rotation) for a location to sag: 17 degrees. A tilted table of 15 degrees counts as
  /// level.
  double sag_share = 0.3;
  /// Cosine above which joints count as parallel: 2.6 degrees. Errors of assembly are a tenth of this angle.
  double parallel_cosine = 0.999;
  /// Largest number of products of sines and cosines in a gravity function along the chain: a tick computes
  /// all of them. An arm of seven joints on a tilted base has 30.
  std::size_t most_terms_of_gravity = 40;
  /// Cosine between the moments of two masses over the rows above which the masses count as one. A hundredth
  /// of the squares then differs, below the resolution of any survey.
  double same_moment = 0.995;
  /// Share of the declared range above which terms name the declared range instead of the measured
  /// range: "200" and not "199.3".
  double declared_range_share = 0.8;
  /// Largest number of steps between runs. More steps can follow any drift and would report a
  /// false jump.
  std::size_t most_steps_of_runs = 4;
  /// Correlation with the row number above which a logged column is a clock or a counter.
  double like_a_clock = 0.95;
  /// Readings for each function of a piecewise linear basis. With fewer readings per function, the table
  /// follows the noise of single readings.
  double readings_per_hat = 4;
  /// Range of the searched time constants. Shortest: this many intervals of the rows, or this part of their
  /// duration if that is longer; longest: this many durations. Beyond this range, a first-order lag is a step
  /// or a straight line.
  double time_least_steps = 3, time_least_part = 200, time_most = 3;
  /// Number of time constants in that range, logarithmic: a factor of 1.5 apart, refined
  /// afterwards.
  std::size_t time_values = 16;
  /// Largest number of summands of a thermal response. A column with two walls and four delays of its
  /// thermometers, in three directions and by height, needs about ten. Source: experiment (columns in finite
  /// differences: 8 to 10).
  std::size_t most_of_response = 12;
  /// Range of the searched decay lengths, as parts of the travel range.
  double travel_least_part = 500, travel_most_part = 2;
  std::size_t travel_values = 14;  // a factor of 1.6 apart, refined afterwards
  /// Periods of the grid: largest number of periods in the range (a periodogram searches shorter periods),
  /// and number of frequencies for each frequency that the range distinguishes. The longest period of the
  /// grid is this share of the range. A longer period is a curve, not a period.
  double most_periods = 100, periods_per_range = 2.5, longest_period_share = 0.4;
  /// Longest period, as a share of the range, for a linear axis that was read at even positions only. There a
  /// short period looks like a long one: six tenths of a period in the range are not yet a parabola.
  double longest_aliased_share = 1.6;
  /// Integer fractions of a revolution that are always tested: gears and bearings up to the
  /// twelfth order.
  std::size_t harmonics_of_turn = 12;
  /// Share of a period that an axis must travel to show a cyclic error of known period. On a shorter travel
  /// the cyclic error is a curve.
  double least_of_a_period = 0.75;
  /// Share of one revolution that a rotary axis must travel to show a cyclic error with the period of one
  /// revolution, the most frequent period: half a revolution.
  double least_of_a_turn = 0.5;
  /// Number of positions of an axis in one approach direction, and share of the rows, above which this
  /// approach direction has a grid of its own.
  std::size_t comb_positions = 6;
  double comb_share = 0.25;
  /// Steps per period: two by the sampling theorem, and a twentieth for steps that are not quite
  /// even.
  double steps_per_period = 2.1;
  /// 1 - cosine below which two locations have the same influence on all readings: sqrt of the rounding, with
  /// three digits of margin.
  double same_place = 1e-7;
  /// A location is excluded if another location has the same influence, this factor stronger: a tilt of 6
  /// degrees.
  double outshone = 10;
  /// Share of the search range by which the fit may move a scanned unknown beyond this range.
  double driven_out = 2;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("candidates.sag_share", sag_share);
    visit("candidates.parallel_cosine", parallel_cosine);
    visit("candidates.outshone", outshone);
    visit("candidates.most_terms_of_gravity", most_terms_of_gravity);
    visit("candidates.same_moment", same_moment);
    visit("candidates.declared_range_share", declared_range_share);
    visit("candidates.most_steps_of_runs", most_steps_of_runs);
    visit("candidates.like_a_clock", like_a_clock);
    visit("candidates.readings_per_hat", readings_per_hat);
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
    visit("candidates.least_of_a_period", least_of_a_period);
    visit("candidates.least_of_a_turn", least_of_a_turn);
    visit("candidates.comb_positions", comb_positions);
    visit("candidates.comb_share", comb_share);
    visit("candidates.steps_per_period", steps_per_period);
    visit("candidates.same_place", same_place);
    visit("candidates.driven_out", driven_out);
  }
};

/// The periodogram below the grid's periods.
struct FinePeriodThresholds {
  /// Number of tested frequencies for each frequency that the range distinguishes. A peak between two tested
  /// frequencies keeps nine tenths of its height.
  double per_range = 3;
  /// Limits of the search for short periods: periods over the range, and periods for each measured position.
  /// The limit of the periods over the range (1000) is a ball screw of 1 mm lead on 1 m. The limit of the
  /// periods per position: fewer positions per period do not show the cyclic error. With twelve positions the
  /// best of a thousand periods explains 80 % of an unrelated pattern, and other periods explain as much. A
  /// cyclic error that was found with so few positions is reported with its aliases (Scanner::aliases).
  double most_periods = 1000, per_position = 80;
  /// Number of peaks of a location that are scored in full, in addition to the slowest of those that fit
  /// nearly as well.
  std::size_t peaks = 3;
  /// Power of the window of the positions, as a share of its largest, above which periods are aliases of each
  /// other. The first value is for candidates, the second value is for the decision.
  double alias_near = 0.8, alias_same = 0.9999;
  /// Power of the window of the positions, as a share of its largest, above which two periods are compared in
  /// full: do the readings distinguish them?
  double alias_partly = 0.9;
  /// Smallest number of frequencies for a search.
  double fewest = 4;
  /// Difference of chi^2 by which the highest peak may exceed a slower peak and still be its alias. Kass and
  /// Raftery 1995: very strong.
  double nearly_as_well = 10;
  /// Difference of chi^2 that distinguishes the periods that are scored in full: the required distance of
  /// alternatives.
  double told_apart = 6;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("fine.per_range", per_range);
    visit("fine.most_periods", most_periods);
    visit("fine.per_position", per_position);
    visit("fine.peaks", peaks);
    visit("fine.alias_near", alias_near);
    visit("fine.alias_same", alias_same);
    visit("fine.alias_partly", alias_partly);
    visit("fine.fewest", fewest);
    visit("fine.nearly_as_well", nearly_as_well);
    visit("fine.told_apart", told_apart);
  }
};

/// Thresholds for a column to count, and the penalty of a candidate.
struct PoolThresholds {
  /// Share of a column's length that remains after projection on the orthogonal complement of the model's
  /// free parameters. Below the first value the column is not visible in the data; below the second, a column
  /// of a piecewise linear basis repeats the other columns. A thousandth of an effect of 100 um is the noise
  /// of a laser.
  double least_own = 1e-3, least_independent = 1e-3;
  /// Share of a column's square that remains after projection on the orthogonal complement of the columns of
  /// a set. Below this value the column is a copy of the set.
  double least_pivot = 1e-5;
  /// Preference for the form nearest to the axis among forms that fit equally well: a difference of the BIC
  /// far below any evidence.
  double step_of_place = 0.05;
  /// Penalty of a form that the catalogue calls rare: twice the logarithm of its relative
  /// frequency, a twentieth.
  double rare = 6;
  /// Number of grid values that count as one test, because neighbouring values explain nearly the same.
  double points_per_try = 2.5;
  /// Number of candidates that enter the pool with one scan, and smallest number for each effect. Source:
  /// experiment.
  std::size_t most_at_once = 50, of_each_effect = 3;
  /// Change of the BIC above which a candidate is refined before it enters the pool. A candidate below this
  /// value never becomes significant.
  double refined_above = -20;
  /// Share of chi^2 per degree of freedom that counts as noise during the ranking; the other half is
  /// attributed to an effect.
  double noise_share = 0.5;
  /// Two periods of one location are different candidates if they differ by more than 1 part in this number.
  double periods_per_e = 8;
  /// First value: share of an item's squares that a span may lack and still contains the item. The second
  /// value is the share for two items that count as equal.
  double held_share = 0.02, same_share = 1e-3;
  /// For rows without a standard uncertainty u, where any remaining structure counts as noise: the simpler
  /// form is the cause if its decrease of chi^2 is more than this share of the decrease by the richer form.
  /// In this case the remaining residual has another cause.
  double simple_share = 0.9;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("pool.least_own", least_own);
    visit("pool.least_independent", least_independent);
    visit("pool.least_pivot", least_pivot);
    visit("pool.step_of_place", step_of_place);
    visit("pool.rare", rare);
    visit("pool.points_per_try", points_per_try);
    visit("pool.most_at_once", most_at_once);
    visit("pool.of_each_effect", of_each_effect);
    visit("pool.refined_above", refined_above);
    visit("pool.noise_share", noise_share);
    visit("pool.periods_per_e", periods_per_e);
    visit("pool.held_share", held_share);
    visit("pool.same_share", same_share);
    visit("pool.simple_share", simple_share);
  }
};

/// Requirements for accepting an effect.
struct AcceptanceThresholds {
  /// Decrease of the BIC that is evidence, and the required distance of an alternative for a named
  /// cause. Kass and Raftery 1995: 6 is strong.
  /// 2 ln 20 = 6: a cause that is more than 20 times less likely than the best one is rejected.
  double evidence = 6, distance = 6;
  /// Distance by the linear estimate up to which an alternative is fitted in full. The fit decides whether
  /// it is within `distance`.
  double distance_of_fits = 12;
  /// Required advantage of a named cause over the instrument alone. Kass and Raftery 1995: 10 is
  /// very strong.
  double instrument_distance = 10;
  /// Share of an effect's motion that changes from row to row. Below this value the effect is as slow as a
  /// drift of the instrument (von Neumann 1941: 1 for random rows). Experiment: temperatures in a survey of
  /// random rows are at 0.01 to 0.1, multiplied by an axis position at 0.3 to 1.
  double slow_share = 0.15;
  /// Share of the decrease on the fit rows that an effect must reach on held-out runs. An effect that was
  /// fitted to noise does not reduce chi^2 of held-out runs; a true effect reduces chi^2 by nearly the same
  /// amount as on the fit rows.
  double held_out_share = 0.2;
  /// In this share of the held-out runs the contribution of an effect must keep its direction, by this cosine
  /// (60 degrees).
  double stable_runs = 0.75, stable_cosine = 0.5;
  /// Share of an effect in one block above which the other blocks cannot confirm the effect.
  double in_one_block = 0.8;
  /// Number of blocks into which a single run is divided; a run with this share of the rows is divided too.
  /// An effect of runs is tested on this many parts of each run.
  std::size_t blocks_of_one_run = 5;
  double large_run = 1.0 / 3;
  std::size_t parts_of_run = 4;
  /// Share of the information on a direction that the other blocks must contain to determine the direction.
  double determined_share = 0.01;
  /// Levels of a feed or a temperature are different if their distance is this share of the fastest feed, or
  /// this many degC. A larger number of levels is a sweep, which is divided into this many parts.
  double same_feed = 0.05, least_warmth_degC = 1;
  std::size_t most_levels = 8, parts_of_sweep = 3;
  /// Largest size of a term as a share of the machine's reach, or of the travel of the rotary axis that
  /// drives the term. This limit applies if the catalogue's own limit, made for machine tools, is smaller:
  /// the eccentricity of a resolver, the sag of a long arm. Joints of humanoid robots yield by one degree in
  /// fifty.
  double size_share = 0.02;
  /// For touches: largest change of a term by the error of the touch in its positions, over that error: the
  /// slope of the term. Errors of machines have slopes below a hundredth.
  double share_of_touch_error = 0.2;
  /// A product of the search is rejected in two cases: fewer readings than this support it, or this share of
  /// its squares is in the span of failed effects.
  double witnesses = 10, copy_of_failed = 0.9;
  /// Number of the best product terms that the search multiplies by one more factor.
  std::size_t extended = 25;
  /// Share of the noise by which two noise models may differ and still count as equal.
  double same_noise = 0.1;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("acceptance.evidence", evidence);
    visit("acceptance.distance", distance);
    visit("acceptance.distance_of_fits", distance_of_fits);
    visit("acceptance.instrument_distance", instrument_distance);
    visit("acceptance.slow_share", slow_share);
    visit("acceptance.held_out_share", held_out_share);
    visit("acceptance.stable_runs", stable_runs);
    visit("acceptance.stable_cosine", stable_cosine);
    visit("acceptance.in_one_block", in_one_block);
    visit("acceptance.blocks_of_one_run", blocks_of_one_run);
    visit("acceptance.large_run", large_run);
    visit("acceptance.parts_of_run", parts_of_run);
    visit("acceptance.determined_share", determined_share);
    visit("acceptance.same_feed", same_feed);
    visit("acceptance.least_warmth_degC", least_warmth_degC);
    visit("acceptance.most_levels", most_levels);
    visit("acceptance.parts_of_sweep", parts_of_sweep);
    visit("acceptance.size_share", size_share);
    visit("acceptance.share_of_touch_error", share_of_touch_error);
    visit("acceptance.witnesses", witnesses);
    visit("acceptance.copy_of_failed", copy_of_failed);
    visit("acceptance.extended", extended);
    visit("acceptance.same_noise", same_noise);
  }
};

/// Minimum of the evidence from held-out rows, for a step and for the whole result.
struct ProofThresholds {
  /// Logarithm of 20: an e-value of 20 is wrong for at most one in twenty absent steps, whatever was tested
  /// before (Ville's inequality).
  double evidence = 2.996;
  /// Expected evidence of a step below which the rows give no information about the step. A true step with so
  /// little expected evidence would be rejected by chance one time in six.
  double least_expected = 2;
  /// Evidence against such a step that counts as worse rows: chi^2 of the check rows increases by 1, their
  /// standard deviation by 1/(2 n) of itself for n rows.
  double worse = 0.5;
  /// Number of standard deviations below the mean of the evidence that one true step in a hundred reaches.
  double chance_sigmas = 2.33;
  /// Limit for the mean square of the check rows, divided by the value that reading and model explain. If
  /// this ratio exceeds 1 by more than this many of its standard deviations, the result is not confirmed on
  /// held-out rows.
  double carries_sigmas = 4;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("proof.evidence", evidence);
    visit("proof.least_expected", least_expected);
    visit("proof.worse", worse);
    visit("proof.chance_sigmas", chance_sigmas);
    visit("proof.carries_sigmas", carries_sigmas);
  }
};

/// Thresholds for the decision whether the residual of the stepwise model is noise, and from which source.
struct VerdictThresholds {
  /// First value: chi^2 per degree of freedom up to this many of its standard deviations above 1 is noise.
  /// Second value: up to this many standard deviations chi^2 alone is sufficient, for up to a given number of
  /// effects.
  double noise_sigmas = 4, hit_sigmas = 2;
  std::size_t few_effects = 2;
  /// Significance level below which the residual has structure, corrected for the number of tests. Also the
  /// level of the runs test for excluded rows that follow each other: a step, not outliers.
  double structure = 1e-4;
  /// chi^2 per degree of freedom up to which the stated uncertainty may be too small: 1.4 of u. With a drift
  /// and chi^2 above it, an accepted effect is a candidate only. Experiment (structures that warm through,
  /// errors outside the catalogue): 1.0 to 1.3 beside the 18 true names, 2.0 to 3.5 beside 10 false ones.
  double doubtful_uncertainty = 2;
  /// chi^2 per degree of freedom above which a too small uncertainty is excluded as the cause: a stated
  /// uncertainty is not three times too small.
  double implausible_uncertainty = 9;
  /// For rows without a standard uncertainty u: share of chi^2 that an accepted stepwise model must explain
  /// for a named cause.
  double mostly_explained = 0.5;
  /// For rows without a standard uncertainty u: factor by which chi^2 must increase if the named effect is
  /// removed. The effect is then larger than the residual beside it.
  double larger_than_rest = 2;
  /// For rows without a standard uncertainty u: share of the check rows' mean square that confirmed steps
  /// must remove for a named cause beside a rest that is not noise. The rest is then a small second cause.
  double explained_on_check = 0.95;
  /// Number of degrees of freedom above which noise larger than the stated value is accepted. Experiment:
  /// outside the catalogue, 160 rows of one reading do not show structure, 400 do.
  double enough_readings = 300;
  /// Noise larger than the stated value is accepted only if no candidate is significant at this level.
  double stands_out = 1e-3;
  /// The instrument is unstable if the correlated part of the errors is this share of the
  /// independent noise, and -2 log likelihood decreases by this much for it.
  double drift_share = 0.7, drift_support = 20;
  /// Number of standard deviations beyond which a reading is an outlier: one in 5e8 of a normal distribution.
  double outlier_spreads = 6;
  /// Number of standard deviations beyond which a reading is an outlier if no u states the standard
  /// deviation: the tails of an effect that was not found are longer.
  double outlier_spreads_without_u = 8;
  /// Share of the rows up to which outliers are the whole cause, and share up to which they are excluded
  /// beside an effect.
  double outliers_alone = 0.05, outliers_beside = 0.15;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("verdict.noise_sigmas", noise_sigmas);
    visit("verdict.hit_sigmas", hit_sigmas);
    visit("verdict.few_effects", few_effects);
    visit("verdict.structure", structure);
    visit("verdict.doubtful_uncertainty", doubtful_uncertainty);
    visit("verdict.implausible_uncertainty", implausible_uncertainty);
    visit("verdict.mostly_explained", mostly_explained);
    visit("verdict.larger_than_rest", larger_than_rest);
    visit("verdict.explained_on_check", explained_on_check);
    visit("verdict.enough_readings", enough_readings);
    visit("verdict.stands_out", stands_out);
    visit("verdict.drift_share", drift_share);
    visit("verdict.drift_support", drift_support);
    visit("verdict.outlier_spreads", outlier_spreads);
    visit("verdict.outlier_spreads_without_u", outlier_spreads_without_u);
    visit("verdict.outliers_alone", outliers_alone);
    visit("verdict.outliers_beside", outliers_beside);
  }
};

/// Thresholds for the test whether an accepted effect has the shape that its name states.
struct ShapeThresholds {
  /// Natural logarithm of the significance level for a doubt about a curve, and about a change along the
  /// axes. The level is strict because every term is tested, so that chance rarely causes a doubt. The levels
  /// are 1e-3 and 1e-4.
  double curve_chance = -6.9, change_chance = -9.2;
  /// Half-waves of a smooth curve, at most and at least: an eighth of the range is the shortest
  /// that a table of 17 stations corrects.
  std::size_t most_half_waves = 8, fewest_half_waves = 3;
  /// Largest permitted share of the shorter half-waves in the decrease of chi^2 by all half-waves.
  double fast_share = 0.15;
  /// Number of coefficients above which a function of an axis is a curve.
  double curve = 3;
  /// Required number of independent functions of the axis in the readings: for each unknown of a curve, and
  /// for each unknown of a period (a period is one of many that were tried).
  double seen_per_unknown = 1.5, seen_per_period = 2;
  /// Positions closer than this share of the range count as one position.
  double apart = 1.0 / 64;
  /// Share of a column beside the others; a column with a smaller share is not independent.
  double own = 1e-3;
  /// Number of positions along the axis at which a jump is tried.
  std::size_t places_of_jump = 64;
  /// Test for pieces of one function: largest numbers of functions that count as separate causes. The values
  /// in order: for an effect of one axis; for an effect of the position, if rows have one reading; for an
  /// effect beside a curve.
  std::size_t most_of_one_axis = 2, most_of_one_reading = 3, most_beside_a_curve = 2;
  /// Number of periods in the range above which a cyclic error is a separate cause (a worm, its gear) and not
  /// a piece, and largest number of such cyclic errors.
  double periods_of_a_wave = 2;
  std::size_t most_waves = 3;
  /// Share of the longer period by which a ratio of two may differ from an integer and be a
  /// harmonic.
  double harmonic = 0.03;
  /// Cosine above which two locations move the readings alike.
  double moves_alike = 0.9;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("shape.curve_chance", curve_chance);
    visit("shape.change_chance", change_chance);
    visit("shape.most_half_waves", most_half_waves);
    visit("shape.fewest_half_waves", fewest_half_waves);
    visit("shape.fast_share", fast_share);
    visit("shape.curve", curve);
    visit("shape.seen_per_unknown", seen_per_unknown);
    visit("shape.seen_per_period", seen_per_period);
    visit("shape.apart", apart);
    visit("shape.own", own);
    visit("shape.places_of_jump", places_of_jump);
    visit("shape.most_of_one_axis", most_of_one_axis);
    visit("shape.most_of_one_reading", most_of_one_reading);
    visit("shape.most_beside_a_curve", most_beside_a_curve);
    visit("shape.periods_of_a_wave", periods_of_a_wave);
    visit("shape.most_waves", most_waves);
    visit("shape.harmonic", harmonic);
    visit("shape.moves_alike", moves_alike);
  }
};

/// All thresholds of a diagnosis.
struct DiagnoseThresholds {
  EvidenceThresholds evidence;
  fit::LayoutThresholds layout;
  fit::NoiseThresholds noise;
  CandidateThresholds candidates;
  FinePeriodThresholds fine;
  PoolThresholds pool;
  AcceptanceThresholds acceptance;
  ProofThresholds proof;
  VerdictThresholds verdict;
  ShapeThresholds shape;

  /// Calls visit("concern.name", number) for every threshold. Numbers are double or std::size_t.
  template <class Visit>
  void for_each(const Visit& visit) {
    evidence.for_each(visit);
    layout.for_each(visit);
    noise.for_each(visit);
    candidates.for_each(visit);
    fine.for_each(visit);
    pool.for_each(visit);
    acceptance.for_each(visit);
    proof.for_each(visit);
    verdict.for_each(visit);
    shape.for_each(visit);
  }
};

}  // namespace vernier::diagnose
