// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstddef>

#include "tools/diagnose/propose/search_extent.h"
#include "tools/fit/noise/noise_thresholds.h"
#include "tools/maths/chance.h"

namespace vernier::diagnose {

// The thresholds of a diagnosis: each has its unit, its meaning and the level from which it is computed. The
// levels (fit/noise/levels.h) are the numbers that were chosen, with their sources. Each subject has one
// struct of thresholds.

/// Thresholds for assumptions about the data, which apply before any candidate is tested.
struct EvidenceThresholds {
  fit::Levels levels{};
  /// Significance level of the test whether the readings of one pose have a common error (analysis of
  /// variance, Searle 1992).
  double pose_chance = levels.chance;
  /// Number of degrees of freedom, both between and within poses, that the test for a common error of a pose
  /// requires.
  double pose_freedom = levels.few_readings;
  /// Tolerance for the intervals between the measured positions of an axis, as a fraction of the smallest
  /// interval. The positions are even if all intervals are multiples of the smallest interval within this
  /// tolerance.
  double even_step = levels.small;
};

/// Thresholds for the candidate effects.
struct CandidateThresholds {
  fit::Levels levels{};
  /// Threshold for a location that can sag under gravity (12 degrees). For a length, the component of its
  /// direction along gravity must be at least this value. For a rotation, the component of its axis across
  /// gravity must be at least this value. Both are components of a unit vector, averaged over the rows.
  double sag_share = levels.minor;
  /// Cosine of the angle between two joint axes above which the axes count as parallel: 2.6 degrees. Assembly
  /// errors of the joint axes are a tenth of this angle.
  double parallel_cosine = 1 - levels.invisible;
  /// Limit for the cosine between the moments of two masses over the rows. If the cosine between the moments
  /// of two masses is above the limit, the two masses count as one mass: a negligible part of the squares
  /// differs.
  double same_moment = std::sqrt(1 - levels.negligible);
  /// Fraction of the declared range of an axis that was measured. If more than this fraction was measured,
  /// the terms of a candidate contain the declared range: "200" and not "199.3".
  double declared_range_share = 1 - levels.minor;
  /// Largest number of jumps between runs in one effect. An effect with more jumps can describe any drift, so
  /// that the diagnosis would report a false jump.
  std::size_t most_steps_of_runs = levels.most_steps;
  /// A logged column is a clock or a counter if its correlation with the row number exceeds this value.
  double like_a_clock = 1 - levels.small;
  /// Number of readings that each function of a piecewise linear basis requires.
  double readings_per_hat = levels.readings_per_coefficient;
  /// Fraction of a known period that an axis must travel to show a cyclic error with this period. If an axis
  /// travels less than this fraction of the period, the cyclic error looks like a curve.
  double least_of_a_period = levels.majority;
  /// Fraction of one revolution that a rotary axis must travel to show a cyclic error with one period per
  /// revolution, the most frequent period.
  double least_of_a_turn = levels.most;
  /// A location is excluded if another location has the same influence on the readings, but is stronger by
  /// this factor (a tilt of 6 degrees).
  double outshone = 1 / levels.alike;
};

/// Thresholds for the aliases of a period.
struct FinePeriodThresholds {
  fit::Levels levels{};
  /// Limits for the power of the spectral window of the positions, as a fraction of its largest power.
  /// `alias_near`: above it two periods may be aliases of each other. `alias_partly`: above it two periods
  /// are compared in full, to test whether the readings distinguish them.
  double alias_near = 1 - levels.minor, alias_partly = 1 - levels.alike;
  /// Largest difference of chi^2 between the highest peak of the periodogram and a slower peak for which the
  /// highest peak may be an alias of the slower peak.
  double nearly_as_well = levels.very_strong();
  /// Smallest difference of chi^2 at which the readings distinguish two periods, if both periods are
  /// evaluated in full.
  double told_apart = levels.strong();
};

/// Thresholds for the columns of candidates, and the penalties of candidates.
struct PoolThresholds {
  fit::Levels levels{};
  /// Smallest fraction of a column's length that must remain after projection on the orthogonal complement of
  /// the model's free parameters. Below `least_own` a column is not visible in the data. Below
  /// `least_independent` a column of a piecewise linear basis repeats the other columns.
  double least_own = levels.invisible, least_independent = levels.invisible;
  /// Penalty of a form that the catalogue marks as rare: strong evidence is needed before it replaces a usual
  /// form.
  double rare = levels.strong();
  /// Fraction of chi^2 per degree of freedom that counts as noise when candidates are ranked. The rest of
  /// chi^2 is attributed to an effect.
  double noise_share = levels.most;
  /// `held_share`: fraction of a candidate's sum of squares that may be outside the span of a set of columns,
  /// if the set contains the candidate. `same_share`: two candidates are equal if at most this fraction of
  /// their sums of squares differs.
  double held_share = levels.negligible, same_share = levels.invisible;
  /// For rows without a standard uncertainty u, where any remaining structure counts as noise. The simpler
  /// form is the cause if its decrease of chi^2 is more than this fraction of the decrease by the richer
  /// form. Then the remaining residual has another cause.
  double simple_share = 1 - levels.alike;
};

/// Thresholds that an effect must meet to be accepted.
struct AcceptanceThresholds {
  fit::Levels levels{};
  /// `evidence`: decrease of the BIC that counts as evidence for an effect. `distance`: increase of the BIC
  /// by which an alternative must be worse for a named cause.
  double evidence = levels.strong(), distance = levels.strong();
  /// Limit of an alternative's distance in the BIC by the linear estimate. An alternative whose linear
  /// estimate of the distance is below the limit is fitted in full. The full fit decides whether the distance
  /// of an alternative is below `distance`.
  double distance_of_fits = 2 * levels.strong();
  /// Required difference of the BIC between a named cause and an error of the instrument alone; the named
  /// cause must have the lower BIC.
  double instrument_distance = levels.very_strong();
  /// Smallest share of an effect's motion that must change from row to row. Below this share the effect is as
  /// slow as a drift of the instrument (von Neumann 1941: the share is 1 for random rows). Experiment: in a
  /// survey with rows in random order, the share that changes from row to row is 0.01 to 0.1 for a
  /// temperature. For a temperature multiplied by an axis position this share is 0.3 to 1.
  double slow_share = levels.minor;
  /// Required decrease of chi^2 on held-out runs, as a fraction of the decrease on the fit rows. An effect
  /// that was fitted to noise does not reduce chi^2 of held-out runs. A true effect reduces chi^2 of held-out
  /// runs nearly as much as chi^2 of the fit rows.
  double held_out_share = levels.minor;
  /// `stable_runs`: fraction of the held-out runs in which the contribution of an effect must keep its
  /// direction. `stable_cosine`: the required cosine (60 degrees).
  double stable_runs = levels.majority, stable_cosine = levels.most;
  /// Limit for the fraction of an effect's sum of squares that is in one block of rows. If this fraction
  /// exceeds the limit, the other blocks cannot confirm the effect.
  double in_one_block = 1 - levels.minor;
  /// Fraction of the information about a parameter combination that the other blocks must contain to
  /// determine this combination. The information is the inverse of a variance: the standard uncertainty from
  /// the other blocks may be ten times as large.
  double determined_share = levels.alike * levels.alike;
  /// Smallest distance between two levels of a quantity. For the feed the distance is a fraction of the
  /// fastest feed; for a temperature it is in degC.
  double same_feed = levels.small, least_warmth_degC = levels.warmth_degC;
  /// Largest size of a term. The size of a length is a fraction of the machine's reach. The size of an angle
  /// is a fraction of the travel of the rotary axis that drives the term. The larger of two limits applies:
  /// this fraction or the limit of the catalogue, which is made for machine tools. Examples of larger terms
  /// are the eccentricity of a resolver and the sag of a long arm. Joints of humanoid robots deflect by one
  /// degree in fifty degrees of travel.
  double size_share = levels.negligible;
  /// Largest contribution of one effect to the residual, as a multiple of the residual (root sum of squares).
  /// A larger contribution is cancelled by the contributions of other effects: the readings then determine
  /// only the sum of these effects.
  double most_of_error = 1 / levels.most;
  /// Largest p-value of a cyclic error beside a curve between the stations of the table of its axis. Above
  /// it the curve explains the readings as well.
  double between_stations = levels.chance;
  /// For touch rows: largest change of a term that the touch error in its positions causes, divided by the
  /// touch error. The ratio of a term's change to the touch error is the slope of the term. Error terms of
  /// real machines have slopes below 0.01.
  double share_of_touch_error = levels.minor;
  /// A product of recorded quantities is rejected if fewer readings than `witnesses` support it. A product is
  /// also rejected if the fraction `copy_of_failed` of its sum of squares is in the span of failed effects.
  double witnesses = levels.few_readings;
  double copy_of_failed = 1 - levels.alike;
  /// Largest difference between two noise models that count as equal, as a fraction of the noise.
  double same_noise = levels.alike;
};

/// Minimum of the evidence from held-out rows, for one step of the stepwise model (one added effect) and for
/// the whole result.
struct ProofThresholds {
  fit::Levels levels{};
  /// Natural logarithm of the required e-value. If the effect of a step is absent, the e-value reaches its
  /// limit in at most one case in twenty. This rate is independent of all earlier tests (Ville's inequality).
  double evidence = std::log(levels.strong_odds);
  /// Natural logarithm of the odds at which the check rows of one file contradict a step. The limit is higher
  /// than that of all check rows, because every step is compared with every file.
  double contradiction = std::log(levels.very_strong_odds);
  /// Number of standard deviations by which the required evidence may be below the mean of the evidence of a
  /// true effect.
  double loss_sigmas = maths::upper_quantile(levels.chance_of_loss);
  /// Limit for the mean square of the check rows divided by its expected value (uncertainty of reading and
  /// model). A result is not confirmed on held-out rows if the mean square ratio exceeds 1 by more than the
  /// given number of its standard deviations.
  double carries_sigmas = levels.sigmas;
};

/// Evidence of an added parameter on held-out rows if its effect is absent: chi^2 of these rows increases by
/// 1 in the mean (Akaike 1974), which is an evidence of -1/2.
inline constexpr double kEvidenceOfNothing = -0.5;

/// Thresholds for the decision whether the residual of the stepwise model is noise, and which source the
/// noise has.
struct VerdictThresholds {
  fit::Levels levels{};
  /// The residual is noise if chi^2 per degree of freedom exceeds 1 by at most this number of its standard
  /// deviations.
  double noise_sigmas = levels.sigmas;
  /// Significance level of the tests for structure in the residual, corrected for the number of tests. The
  /// runs test for excluded rows uses the same level. Excluded rows that follow each other are a step of the
  /// instrument, not outliers.
  double structure = levels.chance_of_many;
  /// Limit for chi^2 per degree of freedom up to which the stated uncertainty u may be too small. If chi^2
  /// per degree of freedom exceeds this limit and the noise has a drift, an accepted effect is a candidate
  /// only. Experiment (structures during warm-up, errors outside the catalogue): with the 18 true names chi^2
  /// per degree of freedom is 1.0 to 1.3; with 10 false names it is 2.0 to 3.5.
  double doubtful_uncertainty = levels.doubtful_u * levels.doubtful_u;
  /// Limit for chi^2 per degree of freedom above which a too small stated uncertainty is not the cause.
  double implausible_uncertainty = levels.implausible_u * levels.implausible_u;
  /// For rows without a standard uncertainty u: fraction of chi^2 that an accepted stepwise model must
  /// explain for a named cause.
  double mostly_explained = levels.most;
  /// For rows without a standard uncertainty u: factor by which chi^2 must increase if the named effect is
  /// removed. With an increase of chi^2 by the factor, the named effect is larger than the remaining
  /// residual.
  double larger_than_rest = 1 / levels.most;
  /// For rows without a standard uncertainty u: fraction of the mean square of the check rows that the
  /// confirmed effects must remove. The limit applies to a named cause whose remaining residual is not noise.
  /// The remaining residual then has a second, small cause.
  double explained_on_check = 1 - levels.small;
  /// `nearly_all`: fraction of chi^2 that may remain beside one effect that explains nearly the whole error.
  /// `of_foreseen`: the search was not linear if the fit of this effect leaves at most this fraction of the
  /// share that the search foresaw.
  double nearly_all = levels.negligible, of_foreseen = levels.most;
  /// Largest structure in a residual of the size of the noise, as a share of the mean square that a certain
  /// step removes.
  double small_structure = levels.small;
  /// Least share of the error beyond u that certain steps explain which are named beside an unexplained rest.
  double most_of_excess = levels.majority;
  /// Number of steps of the readings from which an effect that changes in time is a candidate only.
  std::size_t most_steps = levels.most_steps;
  /// Number of degrees of freedom above which a noise that is larger than the stated uncertainty is accepted.
  double enough_readings = levels.readings_of_structure;
  /// Significance level of candidates. A noise larger than the stated uncertainty is accepted only if no
  /// candidate is significant at this level.
  double stands_out = levels.chance;
  /// The instrument is unstable if two limits are met: the correlated part of the errors relative to the
  /// independent noise (`drift_share`), and the decrease of -2 log likelihood by this part, with very strong
  /// odds for each of its two parameters (`drift_support`).
  double drift_share = levels.majority, drift_support = 2 * levels.very_strong();
  /// Number of standard deviations beyond which a reading is an outlier.
  double outlier_spreads = levels.outlier_sigmas;
  /// Number of standard deviations beyond which a reading is an outlier if the rows have no u: their spread
  /// may be too small, because an effect that was not found has long tails.
  double outlier_spreads_without_u = levels.outlier_sigmas * levels.doubtful_u;
  /// Largest fraction of the rows that may be outliers. With a larger fraction of far rows, an error that is
  /// not in the model is more likely: an error that depends on the previous motion exceeds the limit in one
  /// row of ten.
  double most_outliers = levels.small;
  /// Number of median intervals between rows below which a drift is not a drift of an instrument. An error
  /// that depends on the previous motion changes from row to row.
  double rows_of_a_drift = levels.rows_of_a_drift;
};

/// Thresholds for the test whether an accepted effect really has the shape that its name states.
struct ShapeThresholds {
  fit::Levels levels{};
  /// Natural logarithms of the significance levels for a doubt about a curve, and for a doubt about a term
  /// that changes along the axes.
  double curve_chance = std::log(levels.chance), change_chance = std::log(levels.chance_of_many);
  /// Largest permitted decrease of chi^2 by the short half-waves, as a fraction of the decrease by all
  /// half-waves.
  double fast_share = levels.minor;
  /// Number of independent functions of the axis that the readings must show: for each unknown of a curve,
  /// and for each unknown of a cyclic error (whose period is one of many tested periods).
  double seen_per_unknown = 1 + levels.most, seen_per_period = levels.periods;
  /// Positions with a distance below this fraction of the range count as one position.
  double apart = levels.negligible;
  /// A backlash that changes along the axis is doubtful if a reversal error that builds up explains all but
  /// this share of the change.
  double minor = levels.minor;
  /// Squares of speeds with a distance below this fraction of the largest square count as one speed.
  double squares_apart = levels.alike;
  /// Smallest fraction of a column's length that must remain after projection on the orthogonal complement of
  /// the other columns. A column with a smaller fraction is not independent.
  double own = levels.invisible;
  /// Largest numbers of functions that count as separate causes. More functions are likely pieces of one
  /// function. `most_of_one_axis`: largest number of functions of one axis. `most_of_one_reading`: largest
  /// number of functions of position, if all readings are of one kind. `most_beside_a_curve`: the same if one
  /// of the functions is a curve.
  std::size_t most_of_one_axis = levels.functions_of_axis, most_of_one_reading = levels.functions_of_position,
              most_beside_a_curve = levels.functions_of_axis;
  /// `periods_of_a_wave`: number of periods in the range above which a cyclic error is a separate cause (a
  /// worm or its gear) and not a piece of a function. `most_waves`: largest number of cyclic errors that are
  /// separate causes.
  double periods_of_a_wave = levels.periods;
  std::size_t most_waves = levels.functions_of_position;
  /// Tolerance for harmonics: difference of a ratio of two periods from an integer, as a fraction of the
  /// longer period.
  double harmonic = levels.negligible;
  /// Cosine above which two locations in the chain count as moving the readings in the same way.
  double moves_alike = 1 - levels.alike;
  /// Largest share of the error at the location of an effect that may follow another course over the rows, or
  /// the previous move instead of the approach direction, and natural logarithm of the significance level.
  /// Experiment: 80 surveys of an independent generator with a known error: true names leave 0 to 4 % (p > 1
  /// %), names that only resemble the error 6 to 60 %.
  double course_share = levels.small, course_chance = std::log(levels.chance_of_loss);
  /// Smallest number of moves between two reversals of an axis of which a variance can be estimated.
  double moves = levels.few_readings;
};

/// Coefficients from which a function of an axis is a curve: level, slope and bend.
inline constexpr double kCoefficientsOfCurve = 3;

/// All thresholds of a diagnosis, computed from the levels.
struct DiagnoseThresholds {
  fit::Levels levels{};
  SearchExtent search{};
  EvidenceThresholds evidence{levels};
  fit::LayoutThresholds layout{levels};
  fit::NoiseThresholds noise{levels};
  CandidateThresholds candidates{levels};
  FinePeriodThresholds fine{levels};
  PoolThresholds pool{levels};
  AcceptanceThresholds acceptance{levels};
  ProofThresholds proof{levels};
  VerdictThresholds verdict{levels};
  ShapeThresholds shape{levels};
};

}  // namespace vernier::diagnose
