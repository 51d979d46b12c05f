// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/fit/noise_thresholds.h"

namespace vernier::diagnose {

// Every number of a diagnosis that was chosen and could have been chosen otherwise: one struct a concern,
// each with its unit, its meaning and where it comes from. "Experiment" without a name is the sweep of
// tools/docs/thresholds.md: halved and doubled over surveys of known truth. What is mere numerics (rounds
// until something stands still, sections of a golden search, columns in a batch) stays where it is used.

/// What the data are taken to say before any candidate is looked at.
struct EvidenceThresholds {
  /// Directions of the scaled Jacobian below this share of the largest are not followed by a fit: they show
  /// only through products of errors. Experiment: chains with station tables, whose spectrum has its gap
  /// here.
  double absorb_cutoff = 1e-4;
  /// Numbers in the Jacobian above which every k-th row has to do: 240 MB. A guard against long surveys.
  double most_numbers = 3e7;
  /// Level at which readings of one pose are believed to share an error (analysis of variance). Searle 1992.
  double pose_chance = 1e-3;
  /// Degrees of freedom between and within poses that such a test asks for: below, the variance is known to
  /// no better than a half (sqrt(2/10)).
  double pose_freedom = 10;
  /// Steps of an axis are even where they are multiples of the least one but for this share of it. Stands for
  /// the accuracy of positioning beside the step of a measurement.
  double even_step = 0.05;
  /// Response of a place, as a share of the largest of its kind, below which it is rounding: a point that no
  /// turn about it moves.
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

/// Which candidates there are, and over which values their unknowns are looked for.
struct CandidateThresholds {
  /// Share of a unit vector, on average over the rows, that has to lie along gravity (a length) or across it
  /// (an axis of rotation) for a place to sag: 17 degrees. A tilted table of 15 degrees is level.
  double sag_share = 0.3;
  /// Cosine between joints that count as parallel: 2.6 degrees. Errors of assembly are a tenth of it.
  double parallel_cosine = 0.999;
  /// Products of sines and cosines in a function that gravity has along the chain: a tick computes them all.
  /// An arm of seven joints on a tilted base has 30.
  std::size_t most_terms_of_gravity = 40;
  /// Cosine between the moments of two masses over the rows from which on they are one: a hundredth of the
  /// squares differs, below what any survey resolves.
  double same_moment = 0.995;
  /// Share of the declared range from which on it stands for the range that was read, in terms that name it:
  /// then they read "200" and not "199.3".
  double declared_range_share = 0.8;
  /// More steps between runs than this follow any drift: they would name a jump where there is none.
  std::size_t most_steps_of_runs = 4;
  /// Correlation with the number of the row from which on a logged column is a clock or a counter.
  double like_a_clock = 0.95;
  /// Readings for each hat of a table: fewer let the table follow the noise of single readings.
  double readings_per_hat = 4;
  /// Time constants looked for: from this many spacings of the rows, or this part of their duration where
  /// that is longer, to this many durations. Beyond, a first-order lag is a step or a straight line.
  double time_least_steps = 3, time_least_part = 200, time_most = 3;
  /// Values of a time constant in that range, logarithmic: a factor of 1.5 apart, refined afterwards.
  std::size_t time_values = 16;
  /// Decay lengths: from this part of the range to that part of it.
  double travel_least_part = 500, travel_most_part = 2;
  std::size_t travel_values = 14;  // a factor of 1.6 apart, refined afterwards
  /// Periods on the grid: up to so many in the range (shorter ones are looked for by a periodogram), so many
  /// frequencies for each that the range tells apart, the longest this share of the range (a longer one is no
  /// period yet, but a curve).
  double most_periods = 100, periods_per_range = 2.5, longest_period_share = 0.4;
  /// The same for a linear axis that was read at even positions only, where a short wave looks like a long
  /// one: six tenths of a wave in the range are no parabola yet.
  double longest_aliased_share = 1.6;
  /// Whole fractions of a turn that are always looked at: gears and bearings up to the twelfth order.
  std::size_t harmonics_of_turn = 12;
  /// Share of a period that an axis must travel for that wave, whose period is known: less of it is a curve.
  double least_of_a_period = 0.75;
  /// The same of a wave of one turn, the commonest period of a rotary axis: half of it.
  double least_of_a_turn = 0.5;
  /// Positions of an axis in one sense, and share of the rows, from which on the sense has a comb of its own.
  std::size_t comb_positions = 6;
  double comb_share = 0.25;
  /// Steps per period: the sampling theorem's two, and a twentieth for steps that are not quite even.
  double steps_per_period = 2.1;
  /// 1 - cosine below which two places do the same to all readings: sqrt of rounding, with three digits to
  /// spare.
  double same_place = 1e-7;
  /// How much more strongly another place must do the same for a place to be none: a tilt of 6 degrees.
  double outshone = 10;
  /// Share of a fit's range by which a scanned unknown may leave the range in which it was looked for.
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
  /// Frequencies looked at for each that the range tells apart: a peak between two of them keeps nine tenths.
  double per_range = 3;
  /// Waves over the range, and waves for each position read, beyond which none are looked for: a ball screw
  /// of 1 mm on a metre; a wave of fewer positions is not shown by them.
  /// With twelve positions the best of a thousand waves holds 80 % of a pattern that has nothing to do with
  /// it, and others hold as much: such a cyclic error is reported with its aliases (Scanner::aliases).
  double most_periods = 1000, per_position = 80;
  /// Peaks of a place that are scored in full, beside the slowest of those that do nearly as well.
  std::size_t peaks = 3;
  /// Power of the position's own window, as a share of its largest, at which waves are aliases of one
  /// another: where to look, and where it is so.
  double alias_near = 0.8, alias_same = 0.9999;
  /// The same from which on two waves are compared in full, whether the readings tell them apart.
  double alias_partly = 0.9;
  /// Frequencies that are worth the search.
  double fewest = 4;
  /// chi^2 by which the highest peak may lead over a slower one that it may be the alias of. Kass and Raftery
  /// 1995: very strong.
  double nearly_as_well = 10;
  /// The same among the periods that are scored in full: as far apart as rivals must be.
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

/// What a column must be to count, and what a candidate costs.
struct PoolThresholds {
  /// Share of a column's length outside of the model's reach below which the data cannot see it, and below
  /// which a column of hats repeats the others. A thousandth of an effect of 100 um is the noise of a laser.
  double least_own = 1e-3, least_independent = 1e-3;
  /// Share of a column's square left beside the columns of a set below which it is a copy of them.
  double least_pivot = 1e-5;
  /// Between forms that fit alike the one nearest to the axis: a step of the BIC far below any
  /// evidence.
  double step_of_place = 0.05;
  /// Twice the logarithm of how much more seldom than the others a form is met that the catalogue calls so: a
  /// twentieth.
  double rare = 6;
  /// Values of a grid that are one try: neighbours explain nearly the same.
  double points_per_try = 2.5;
  /// Candidates that enter the pool with one scan, and of each effect at least. Experiment.
  std::size_t most_at_once = 50, of_each_effect = 3;
  /// Criterion above which a candidate is refined before it enters: none that far off comes back.
  double refined_above = -20;
  /// Share of chi^2 per freedom taken for the noise while the scan ranks: half of it is some effect's.
  double noise_share = 0.5;
  /// Periods of one place are different candidates where they differ by one part in this.
  double periods_per_e = 8;
  /// Share of another's squares that a span may miss and still holds it; and where two are the same.
  double held_share = 0.02, same_share = 1e-3;
  /// Without u, where any structure left over counts as noise: share of what a richer form
  /// explains from which on the simpler one that it holds is the cause, and the rest another matter.
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

/// What an effect must show to be accepted.
struct AcceptanceThresholds {
  /// Decrease of the BIC that is evidence, and the distance that an alternative must keep for a name to be
  /// given. Kass and Raftery 1995: 6 is strong.
  double evidence = 6, distance = 6;
  /// How much better a name must do than the instrument alone. Kass and Raftery 1995: 10 is very strong.
  double instrument_distance = 10;
  /// Share of what an effect moves in all that it moves from row to row, below which it is as slow as a drift
  /// of the instrument (von Neumann 1941: 1 for rows at random). Experiment: temperatures in a survey of rows
  /// at random are at 0.01 to 0.1, carried by an axis at 0.3 to 1.
  double slow_share = 0.15;
  /// Of what an effect removes from the rows that it was fitted to, this much it removes from runs that were
  /// left out. An effect of the noise removes nothing there, a true one nearly all.
  double held_out_share = 0.2;
  /// In this share of the runs left out its part keeps its direction, by this cosine (60 degrees).
  double stable_runs = 0.75, stable_cosine = 0.5;
  /// Share of an effect in one block beyond which the others cannot tell of it.
  double in_one_block = 0.8;
  /// A single run is cut into this many blocks, a run with this share of the rows too, and an effect of runs
  /// is tested on this many parts of each.
  std::size_t blocks_of_one_run = 5;
  double large_run = 1.0 / 3;
  std::size_t parts_of_run = 4;
  /// Information on a direction that the other blocks must hold for it to be theirs, as a share.
  double determined_share = 0.01;
  /// Levels of a feed or a temperature: apart by this share of the fastest feed, by so many degC; more levels
  /// than this are a sweep, which is cut into so many parts.
  double same_feed = 0.05, least_warmth_degC = 1;
  std::size_t most_levels = 8, parts_of_sweep = 3;
  /// Share of the machine's reach, or of the travel of the rotary axis that drives it, up to which a term may
  /// grow where the catalogue's own limit, made for machine tools, is less: the eccentricity of a resolver,
  /// the sag of a long arm. Joints of humanoids give way by a degree in fifty.
  double size_share = 0.02;
  /// A product of the search is hollow with fewer readings than this behind it, or with this share of its
  /// squares in the span of what failed.
  double witnesses = 10, copy_of_failed = 0.9;
  /// Products that are tried with one factor more.
  std::size_t extended = 25;
  /// Share of the noise by which two noise models may differ and say the same.
  double same_noise = 0.1;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("acceptance.evidence", evidence);
    visit("acceptance.distance", distance);
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
    visit("acceptance.witnesses", witnesses);
    visit("acceptance.copy_of_failed", copy_of_failed);
    visit("acceptance.extended", extended);
    visit("acceptance.same_noise", same_noise);
  }
};

/// What rows that no fit and no selection saw must say of a step, and of the whole answer.
struct ProofThresholds {
  /// log of 20: an e-value of 20 is wrong for one step in twenty at most that is not there, whatever was
  /// looked at before (Ville's inequality).
  double evidence = 2.996;
  /// Expected evidence of a step below which the rows give no information about it: a true one would be
  /// denied by chance one time in six.
  double least_expected = 2;
  /// Spreads of that evidence below its mean that one true step in a hundred falls by.
  double chance_sigmas = 2.33;
  /// Mean square of the check rows, over what reading and model explain: beyond so many of its own standard
  /// deviations above 1 the answer does not carry to rows that it was not made from.
  double carries_sigmas = 4;

  template <class Visit>
  void for_each(const Visit& visit) {
    visit("proof.evidence", evidence);
    visit("proof.least_expected", least_expected);
    visit("proof.chance_sigmas", chance_sigmas);
    visit("proof.carries_sigmas", carries_sigmas);
  }
};

/// Is what the ladder leaves noise, and whose?
struct VerdictThresholds {
  /// chi^2 per degree of freedom up to this many of its own standard deviations above 1 is noise; up to so
  /// many it is enough by itself, for up to so many effects.
  double noise_sigmas = 4, hit_sigmas = 2;
  std::size_t few_effects = 2;
  /// Level below which what is left has structure, after the number of looks.
  double structure = 1e-4;
  /// chi^2 per freedom up to which the stated uncertainty may be in doubt: 1.4 of u.
  double doubtful_uncertainty = 2;
  /// ... and beyond which it is not: nobody states a third of his uncertainty.
  double implausible_uncertainty = 9;
  /// Without u: share of chi^2 that an accepted ladder explains, for its name to be believed.
  double mostly_explained = 0.5;
  /// ... and how many times chi^2 must grow without the effect that is named: then it is larger than all that
  /// is left beside it.
  double larger_than_rest = 2;
  /// More noise than stated is believed from so many degrees of freedom on. Experiment: outside the
  /// catalogue, 160 rows of one reading do not show structure, 400 do.
  double enough_readings = 300;
  /// ... and only where no candidate stands out of it at this level.
  double stands_out = 1e-3;
  /// The instrument does not hold still where the correlated part of the errors is this share of the
  /// readings' own noise, and -2 log likelihood falls by this much for it.
  double drift_share = 0.7, drift_support = 20;
  /// Spreads beyond which a reading is an outlier: one in 5e8 of a normal distribution.
  double outlier_spreads = 6;
  /// The same where no u says how large the spread may be: tails of an effect that was not found reach
  /// further.
  double outlier_spreads_without_u = 8;
  /// Share of the rows up to which outliers are the whole answer, and up to which they are left out beside an
  /// effect.
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

/// Is an accepted effect what its name says?
struct ShapeThresholds {
  /// Natural logarithm of the level at which a curve is doubted, and a change along the axes: every term is
  /// asked, and none should be doubted by chance. 1e-3 and 1e-4.
  double curve_chance = -6.9, change_chance = -9.2;
  /// Half-waves of a smooth curve, at most and at least: an eighth of the range is the shortest that a table
  /// of 17 stations takes away.
  std::size_t most_half_waves = 8, fewest_half_waves = 3;
  /// Share of what all half-waves explain that may be faster.
  double fast_share = 0.15;
  /// Coefficients from which on a function of an axis is a curve.
  double curve = 3;
  /// Independent functions of the axis that the readings show, for each unknown of a curve, and of a period
  /// (one of many that were tried).
  double seen_per_unknown = 1.5, seen_per_period = 2;
  /// Positions closer than this share of the range are one.
  double apart = 1.0 / 64;
  /// Share of a column beside the others below which it is none of its own.
  double own = 1e-3;
  /// Places along the axis at which a jump is tried.
  std::size_t places_of_jump = 64;
  /// Pieces of one function: so many functions of one axis, so many of position where rows have one reading,
  /// so many beside a curve, are believed to be as many causes.
  std::size_t most_of_one_axis = 2, most_of_one_reading = 3, most_beside_a_curve = 2;
  /// Periods of a wave in the range from which on it is a cause of its own (a worm, its gear) and no piece,
  /// and how many such waves are believed.
  double periods_of_a_wave = 2;
  std::size_t most_waves = 3;
  /// Share of the longer period by which a ratio of two may miss a whole number and be a harmonic.
  double harmonic = 0.03;
  /// Cosine from which on two places move the readings alike.
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

/// All of a diagnosis.
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

  /// Calls visit("concern.name", number) for every one; numbers are double or std::size_t.
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
