// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/fit/noise/noise_thresholds.h"

namespace vernier::diagnose {

// All thresholds of a diagnosis: numbers that were chosen and could have other values. Each subject has one
// struct of thresholds. Each threshold has its unit, meaning and source. "Experiment" without a name means
// the sweep of tools/docs/thresholds.md: each threshold was halved and doubled over surveys with a known
// error. Purely numerical constants (iterations until convergence, steps of a golden section search, columns
// in a batch) are in the source files that use them.

/// Thresholds for assumptions about the data, which apply before any candidate is tested.
struct EvidenceThresholds {
  /// Limit for the singular values of the scaled Jacobian, as a fraction of the largest singular value. A fit
  /// does not change the parameters along a direction whose singular value is below the limit. Parameter
  /// directions with a singular value below the limit are visible only through products of errors. Source:
  /// experiment with chains with station tables, whose singular values have a gap at the limit.
  double absorb_cutoff = 1e-4;
  /// Largest number of elements of the Jacobian (240 MB). In a long survey with more elements, only every
  /// k-th row is used.
  double most_numbers = 3e7;
  /// Significance level of the test whether the readings of one pose have a common error (analysis of
  /// variance, Searle 1992).
  double pose_chance = 1e-3;
  /// Number of degrees of freedom, both between and within poses, that the test for a common error of a pose
  /// requires. With fewer than 10 degrees of freedom, the relative uncertainty of the variance exceeds 45 %
  /// (sqrt(2/10)).
  double pose_freedom = 10;
  /// Tolerance for the intervals between the measured positions of an axis, as a fraction of the smallest
  /// interval. The positions are even if all intervals are multiples of the smallest interval within this
  /// tolerance. The tolerance of 5 % represents the positioning accuracy relative to the interval of a
  /// measurement.
  double even_step = 0.05;
  /// Smallest response of the readings to a motion at a location in the chain (axis and degree of freedom).
  /// The response is a fraction of the largest response to motions of the same kind. A smaller response of
  /// the readings is only rounding error. Example of a response that is only rounding error: a rotation about
  /// an axis through the measured point.
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

/// Thresholds for the candidate effects, and for the values over which their scanned unknowns are searched.
struct CandidateThresholds {
  /// Threshold for a location that can sag under gravity (17 degrees). For a length, the component of its
  /// direction along gravity must be at least this value. For a rotation, the component of its axis across
  /// gravity must be at least this value. Both are components of a unit vector, averaged over the rows. A
  /// table that is tilted by 15 degrees counts as level.
  double sag_share = 0.3;
  /// Cosine of the angle between two joint axes above which the axes count as parallel: 2.6 degrees. Assembly
  /// errors of the joint axes are a tenth of this angle.
  double parallel_cosine = 0.999;
  /// Largest number of products of sines and cosines in a gravity function along the chain, because each tick
  /// of the control computes all products. The gravity function of a seven-joint arm on a tilted base has 30
  /// products.
  std::size_t most_terms_of_gravity = 40;
  /// Limit for the cosine between the moments of two masses over the rows. If the cosine between the moments
  /// of two masses is above the limit, the two masses count as one mass. At the limit of the cosine, a
  /// hundredth of the squares differs between the moments of two masses, which is below the resolution of any
  /// survey.
  double same_moment = 0.995;
  /// Fraction of the declared range of an axis that was measured. If more than this fraction was measured,
  /// the terms of a candidate contain the declared range: "200" and not "199.3".
  double declared_range_share = 0.8;
  /// Largest number of jumps between runs in one effect. An effect with more than four jumps can describe any
  /// drift, so that the diagnosis would report a false jump.
  std::size_t most_steps_of_runs = 4;
  /// A logged column is a clock or a counter if its correlation with the row number exceeds this value.
  double like_a_clock = 0.95;
  /// Number of readings that each function of a piecewise linear basis requires. With fewer readings per
  /// function, the table follows the noise of single readings.
  double readings_per_hat = 4;
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
  /// Fraction of a known period that an axis must travel to show a cyclic error with this period. If an axis
  /// travels less than this fraction of the period, the cyclic error looks like a curve.
  double least_of_a_period = 0.75;
  /// Fraction of one revolution that a rotary axis must travel to show a cyclic error with one period per
  /// revolution, the most frequent period.
  double least_of_a_turn = 0.5;
  /// An approach direction of an axis has its own grid of positions if two limits are exceeded:
  /// `comb_positions`, a number of positions, and `comb_share`, a fraction of the rows.
  std::size_t comb_positions = 6;
  double comb_share = 0.25;
  /// Shortest searched period, in intervals between the measured positions: two intervals by the sampling
  /// theorem, plus a twentieth for intervals that are not quite equal.
  double steps_per_period = 2.1;
  /// Limit for 1 - cosine of the influences of two locations on all readings. If 1 - cosine is below the
  /// limit, the influences of both locations are equal. The value is sqrt of the rounding error, with three
  /// digits of margin.
  double same_place = 1e-7;
  /// A location is excluded if another location has the same influence on the readings, but is stronger by
  /// this factor (a tilt of 6 degrees).
  double outshone = 10;
  /// Factor by which the fit may move a scanned unknown beyond the limits of its search range.
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

/// Thresholds for the periodogram, which searches periods shorter than those of the grid.
struct FinePeriodThresholds {
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
  /// Limits for the power of the spectral window of the positions, as a fraction of its largest power. Two
  /// periods are aliases of each other if this power is above the limit. `alias_near` is the limit for a
  /// possible alias. `alias_same` is the limit for the decision.
  double alias_near = 0.8, alias_same = 0.9999;
  /// Limit for the power of the spectral window of the positions, as a fraction of its largest power. If the
  /// power of the spectral window exceeds the limit, two periods are compared in full, to test whether the
  /// readings distinguish them.
  double alias_partly = 0.9;
  /// Smallest number of tested frequencies for which the search for short periods is done.
  double fewest = 4;
  /// Largest difference of chi^2 between the highest peak of the periodogram and a slower peak for which the
  /// highest peak may be an alias of the slower peak. Source of the value 10: "very strong" evidence by Kass
  /// and Raftery 1995.
  double nearly_as_well = 10;
  /// Smallest difference of chi^2 at which the readings distinguish two periods, if both periods are
  /// evaluated in full. The value is the same as `distance`, the required difference of the BIC between a
  /// cause and an alternative cause.
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

/// Thresholds for the columns of candidates, and the penalties of candidates.
struct PoolThresholds {
  /// Smallest fraction of a column's length that must remain after projection on the orthogonal complement of
  /// the model's free parameters. Below `least_own` a column is not visible in the data. Below
  /// `least_independent` a column of a piecewise linear basis repeats the other columns. A thousandth of an
  /// effect of 100 um is as small as the noise of a laser interferometer.
  double least_own = 1e-3, least_independent = 1e-3;
  /// Smallest fraction of a column's squared length that must remain after projection on the orthogonal
  /// complement of the columns of a set. A column with a smaller fraction is a linear combination of the set.
  double least_pivot = 1e-5;
  /// Preference for the form nearest to the axis if several forms fit equally well. The preference is a
  /// difference of the BIC, far below any evidence.
  double step_of_place = 0.05;
  /// Penalty of a form that the catalogue marks as rare: twice the negative logarithm of its relative
  /// frequency, which is one in twenty.
  double rare = 6;
  /// Number of values of the search grid that count as one test, because neighbouring values explain nearly
  /// the same.
  double points_per_try = 2.5;
  /// Number of candidates that one scan adds to the pool, and smallest number of candidates for each effect.
  /// Source: experiment.
  std::size_t most_at_once = 50, of_each_effect = 3;
  /// Change of the BIC above which a candidate's scanned values are refined before the candidate is added to
  /// the pool. A candidate with a smaller change of the BIC never becomes significant.
  double refined_above = -20;
  /// Fraction of chi^2 per degree of freedom that counts as noise when candidates are ranked. The other half
  /// of chi^2 is attributed to an effect.
  double noise_share = 0.5;
  /// Two periods at one location are different candidates if they differ by more than one part in
  /// `periods_per_e` (here one eighth).
  double periods_per_e = 8;
  /// `held_share`: fraction of a candidate's sum of squares that may be outside the span of a set of columns,
  /// if the set contains the candidate. `same_share`: two candidates are equal if at most this fraction of
  /// their sums of squares differs.
  double held_share = 0.02, same_share = 1e-3;
  /// For rows without a standard uncertainty u, where any remaining structure counts as noise. The simpler
  /// form is the cause if its decrease of chi^2 is more than this fraction of the decrease by the richer
  /// form. Then the remaining residual has another cause.
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

/// Thresholds that an effect must meet to be accepted.
struct AcceptanceThresholds {
  /// `evidence`: decrease of the BIC that counts as evidence for an effect. `distance`: increase of the BIC
  /// by which an alternative must be worse for a named cause. Kass and Raftery 1995: a difference of 6 in the
  /// BIC is strong evidence. The distance 6 is 2 ln 20: a cause that is more than 20 times less likely than
  /// the best cause is rejected.
  double evidence = 6, distance = 6;
  /// Limit of an alternative's distance in the BIC by the linear estimate. An alternative whose linear
  /// estimate of the distance is below the limit is fitted in full. The full fit decides whether the distance
  /// of an alternative is below `distance`.
  double distance_of_fits = 12;
  /// Required difference of the BIC between a named cause and an error of the instrument alone; the named
  /// cause must have the lower BIC. Kass and Raftery 1995: a difference of 10 in the BIC is very strong
  /// evidence.
  double instrument_distance = 10;
  /// Smallest share of an effect's motion that must change from row to row. Below this share the effect is as
  /// slow as a drift of the instrument (von Neumann 1941: the share is 1 for random rows). Source:
  /// experiment. In a survey with rows in random order, the share that changes from row to row is 0.01 to 0.1
  /// for a temperature. For a temperature multiplied by an axis position this share is 0.3 to 1.
  double slow_share = 0.15;
  /// Required decrease of chi^2 on held-out runs, as a fraction of the decrease on the fit rows. An effect
  /// that was fitted to noise does not reduce chi^2 of held-out runs. A true effect reduces chi^2 of held-out
  /// runs nearly as much as chi^2 of the fit rows.
  double held_out_share = 0.2;
  /// `stable_runs`: fraction of the held-out runs in which the contribution of an effect must keep its
  /// direction. `stable_cosine`: the required cosine (60 degrees).
  double stable_runs = 0.75, stable_cosine = 0.5;
  /// Limit for the fraction of an effect's sum of squares that is in one block of rows. If this fraction
  /// exceeds the limit, the other blocks cannot confirm the effect.
  double in_one_block = 0.8;
  /// `blocks_of_one_run`: number of blocks into which a single run is divided. `large_run`: a run with this
  /// fraction of the rows is divided too. `parts_of_run`: an effect of runs is tested on this many parts of
  /// each run.
  std::size_t blocks_of_one_run = 5;
  double large_run = 1.0 / 3;
  std::size_t parts_of_run = 4;
  /// Fraction of the information about a parameter combination that the other blocks must contain to
  /// determine this combination.
  double determined_share = 0.01;
  /// Smallest distance between two levels of a quantity. For the feed the distance is a fraction of the
  /// fastest feed; for a temperature it is in degC. If a quantity has more than `most_levels` levels, it is a
  /// sweep and is divided into `parts_of_sweep` parts.
  double same_feed = 0.05, least_warmth_degC = 1;
  std::size_t most_levels = 8, parts_of_sweep = 3;
  /// Largest size of a term. The size of a length is a fraction of the machine's reach. The size of an angle
  /// is a fraction of the travel of the rotary axis that drives the term. The larger of two limits applies:
  /// this fraction or the limit of the catalogue, which is made for machine tools. Examples of larger terms
  /// are the eccentricity of a resolver and the sag of a long arm. Joints of humanoid robots deflect by one
  /// degree in fifty degrees of travel.
  double size_share = 0.02;
  /// Largest contribution of one effect to the residual, as a multiple of the residual (root sum of squares).
  /// A larger contribution is cancelled by the contributions of other effects: the readings then determine
  /// only the sum of these effects.
  double most_of_error = 2;
  /// For touch rows: largest change of a term that the touch error in its positions causes, divided by the
  /// touch error. The ratio of a term's change to the touch error is the slope of the term. Error terms of
  /// real machines have slopes below 0.01.
  double share_of_touch_error = 0.2;
  /// A product of recorded quantities is rejected if fewer readings than `witnesses` support it. A product is
  /// also rejected if the fraction `copy_of_failed` of its sum of squares is in the span of failed effects.
  double witnesses = 10, copy_of_failed = 0.9;
  /// Number of the best products of recorded quantities that the search multiplies by one more factor.
  std::size_t extended = 25;
  /// Largest difference between two noise models that count as equal, as a fraction of the noise.
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
    visit("acceptance.most_of_error", most_of_error);
    visit("acceptance.share_of_touch_error", share_of_touch_error);
    visit("acceptance.witnesses", witnesses);
    visit("acceptance.copy_of_failed", copy_of_failed);
    visit("acceptance.extended", extended);
    visit("acceptance.same_noise", same_noise);
  }
};

/// Minimum of the evidence from held-out rows, for one step of the stepwise model (one added effect) and for
/// the whole result.
struct ProofThresholds {
  /// Natural logarithm of the required e-value, which is 20. If the effect of a step is absent, the e-value
  /// reaches 20 in at most one case in twenty. This rate is independent of all earlier tests (Ville's
  /// inequality).
  double evidence = 2.996;
  /// Limit for the expected evidence of a step of the stepwise model. If the expected evidence is below the
  /// limit, the held-out rows give no information about the step. With an expected evidence of only 2, a true
  /// effect is rejected by chance one time in six.
  double least_expected = 2;
  /// Limit of the evidence against a step of the stepwise model, for a step whose expected evidence is small.
  /// If the evidence against this step reaches the limit, the step counts as wrong. At the limit, chi^2 of
  /// the check rows increases by 1, and their standard deviation by the factor 1/(2 n) for n rows.
  double worse = 0.5;
  /// Number of standard deviations by which the required evidence may be below the mean of the evidence. One
  /// true effect in a hundred has still less evidence.
  double chance_sigmas = 2.33;
  /// Limit for the mean square of the check rows divided by its expected value (uncertainty of reading and
  /// model). A result is not confirmed on held-out rows if the mean square ratio exceeds 1 by more than the
  /// given number of its standard deviations.
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

/// Thresholds for the decision whether the residual of the stepwise model is noise, and which source the
/// noise has.
struct VerdictThresholds {
  /// `noise_sigmas`: the residual is noise if chi^2 per degree of freedom exceeds 1 by at most this number of
  /// its standard deviations. `hit_sigmas`: chi^2 alone is sufficient for this decision up to this number of
  /// standard deviations, if the model has at most `few_effects` effects.
  double noise_sigmas = 4, hit_sigmas = 2;
  std::size_t few_effects = 2;
  /// Significance level of the tests for structure in the residual, corrected for the number of tests. The
  /// runs test for excluded rows uses the same level. Excluded rows that follow each other are a step of the
  /// instrument, not outliers.
  double structure = 1e-4;
  /// Limit for chi^2 per degree of freedom up to which the stated uncertainty u may be too small (by a factor
  /// of 1.4). If chi^2 per degree of freedom exceeds this limit and the noise has a drift, an accepted effect
  /// is a candidate only. Source: experiment (structures during warm-up, errors outside the catalogue). With
  /// the 18 true names chi^2 per degree of freedom is 1.0 to 1.3; with 10 false names it is 2.0 to 3.5.
  double doubtful_uncertainty = 2;
  /// Limit for chi^2 per degree of freedom above which a too small stated uncertainty is not the cause. A
  /// stated uncertainty is not too small by a factor of three.
  double implausible_uncertainty = 9;
  /// For rows without a standard uncertainty u: fraction of chi^2 that an accepted stepwise model must
  /// explain for a named cause.
  double mostly_explained = 0.5;
  /// For rows without a standard uncertainty u: factor by which chi^2 must increase if the named effect is
  /// removed. With an increase of chi^2 by the factor, the named effect is larger than the remaining
  /// residual.
  double larger_than_rest = 2;
  /// For rows without a standard uncertainty u: fraction of the mean square of the check rows that the
  /// confirmed effects must remove. The limit applies to a named cause whose remaining residual is not noise.
  /// The remaining residual then has a second, small cause.
  double explained_on_check = 0.95;
  /// Number of degrees of freedom above which a noise that is larger than the stated uncertainty is accepted.
  /// Source: experiment with errors outside the catalogue. With one reading per row, 160 rows do not show the
  /// structure of the residual, and 400 rows do.
  double enough_readings = 300;
  /// Significance level of candidates. A noise larger than the stated uncertainty is accepted only if no
  /// candidate is significant at this level.
  double stands_out = 1e-3;
  /// The instrument is unstable if two limits are met: the correlated part of the errors relative to the
  /// independent noise (`drift_share`), and the decrease of -2 log likelihood by this part (`drift_support`).
  double drift_share = 0.7, drift_support = 20;
  /// Number of standard deviations beyond which a reading is an outlier. A normal distribution exceeds the
  /// outlier limit once in 5e8 readings.
  double outlier_spreads = 6;
  /// Number of standard deviations beyond which a reading is an outlier if the rows have no u. The limit is
  /// larger because an effect that was not found has long tails.
  double outlier_spreads_without_u = 8;
  /// Largest fraction of the rows that may be outliers. With a larger fraction of far rows, an error that is
  /// not in the model is more likely: an error that depends on the previous motion exceeds the limit in one
  /// row of ten. Source: experiment. With gross errors in 3 % of the rows, at most 5.3 % were excluded.
  double most_outliers = 0.06;
  /// Number of median intervals between rows below which a drift is not a drift of an instrument, because an
  /// instrument changes slowly. An error that depends on the previous motion changes from row to row.
  double rows_of_a_drift = 3;

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
    visit("verdict.most_outliers", most_outliers);
    visit("verdict.rows_of_a_drift", rows_of_a_drift);
  }
};

/// Thresholds for the test whether an accepted effect really has the shape that its name states.
struct ShapeThresholds {
  /// Natural logarithms of the significance levels for a doubt about a curve, and for a doubt about a term
  /// that changes along the axes. The significance levels are strict, because every term is tested and chance
  /// must rarely cause a doubt. The significance levels are 1e-3 (curve) and 1e-4 (change along the axes).
  double curve_chance = -6.9, change_chance = -9.2;
  /// Largest and smallest number of half-waves in a smooth curve. An eighth of the range is the shortest
  /// half-wave that a table of 17 stations can correct.
  std::size_t most_half_waves = 8, fewest_half_waves = 3;
  /// Largest permitted decrease of chi^2 by the short half-waves, as a fraction of the decrease by all
  /// half-waves.
  double fast_share = 0.15;
  /// Number of coefficients above which a function of an axis counts as a curve.
  double curve = 3;
  /// Number of independent functions of the axis that the readings must show: for each unknown of a curve,
  /// and for each unknown of a cyclic error (whose period is one of many tested periods).
  double seen_per_unknown = 1.5, seen_per_period = 2;
  /// Positions with a distance below this fraction of the range count as one position.
  double apart = 1.0 / 64;
  /// Smallest fraction of a column's length that must remain after projection on the orthogonal complement of
  /// the other columns. A column with a smaller fraction is not independent.
  double own = 1e-3;
  /// Number of positions along the axis at which the test assumes a jump.
  std::size_t places_of_jump = 64;
  /// Largest numbers of functions that count as separate causes. More functions are likely pieces of one
  /// function. `most_of_one_axis`: largest number of functions of one axis. `most_of_one_reading`: largest
  /// number of functions of position, if all readings are of one kind. `most_beside_a_curve`: the same if one
  /// of the functions is a curve.
  std::size_t most_of_one_axis = 2, most_of_one_reading = 3, most_beside_a_curve = 2;
  /// `periods_of_a_wave`: number of periods in the range above which a cyclic error is a separate cause (a
  /// worm or its gear) and not a piece of a function. `most_waves`: largest number of cyclic errors that are
  /// separate causes.
  double periods_of_a_wave = 2;
  std::size_t most_waves = 3;
  /// Tolerance for harmonics: difference of a ratio of two periods from an integer, as a fraction of the
  /// longer period.
  double harmonic = 0.03;
  /// Cosine above which two locations in the chain count as moving the readings in the same way.
  double moves_alike = 0.9;
  /// Largest share of the error at the location of an effect that may follow another course over the rows, or
  /// the previous move instead of the approach direction, and natural logarithm of the significance level
  /// (1 %). Source: 80 surveys of an independent generator with a known error: true names leave 0 to 4 % (p >
  /// 1 %), names that only resemble the error 6 to 60 %.
  double course_share = 0.05, course_chance = -4.6;

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
    visit("shape.course_share", course_share);
    visit("shape.course_chance", course_chance);
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

  /// Calls visit("concern.name", number) for every threshold of the diagnosis. The type of a threshold is
  /// double or std::size_t.
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
