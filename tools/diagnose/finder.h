// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"
#include "tools/diagnose/propose/products.h"
#include "tools/diagnose/propose/responses.h"
#include "tools/diagnose/propose/scan.h"
#include "tools/diagnose/propose/selection.h"

namespace vernier::diagnose {

/// Another effect that can replace an accepted effect as the cause.
struct Alternative {
  std::size_t item = 0;  // index of the alternative in the pool of candidates
  double distance = 0;   // BIC with the alternative minus BIC of the accepted set
};

/// Other effects that explain the readings nearly as well as an accepted effect.
struct Alternatives {
  std::vector<Alternative> other;  // other causes, in order of the distance in BIC
  std::vector<std::size_t> same;   // candidates with the same columns, from the same kinds of quantities

  /// Returns the alternatives whose distance in BIC is at most `distance`, in the order of the list.
  std::vector<std::size_t> within(double distance) const;
};

/// A candidate that held-out rows contradict, and the reason for the user.
struct Contradicted {
  std::size_t item = 0;
  std::string why;
};

/// Searches the candidate effects of one fitted machine for the set that explains the residual of the fit.
/// Finder keeps the candidate effects that pass every acceptance test. Finder uses the linearised problem and
/// makes no new fit.
class Finder {
 public:
  /// `fitted`: the machine at its best fit. `progress`: receives the completed fraction of the diagnosis (0
  /// to 1) and the name of the current operation.
  Finder(const model::Machine& fitted, const model::Measurement& measurement,
         const std::vector<effects::Effect>& effects, std::size_t most_effects,
         std::function<void(double, const std::string&)> progress, const DiagnoseThresholds& thresholds = {});
  Finder(const Finder&) = delete;
  Finder& operator=(const Finder&) = delete;

  /// Searches the catalogue of effects first. If the residual then exceeds the noise, searches products of
  /// recorded quantities.
  void find();

  /// Searches on without these candidates, and without those of the same columns.
  void find_without(const std::vector<Contradicted>& items);

  /// Returns the indices of the accepted effects in the pool; the effect that explains most is first.
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  const Pool& pool() const { return pool_; }
  const Evidence& evidence() const { return evidence_; }
  /// Returns the noise model of the readings (correlation of their errors) with the accepted effects in the
  /// model.
  fit::NoiseModel noise() const;
  const std::vector<ScannedCandidate>& candidates() const { return list_; }

  /// Returns the coefficients of a candidate's columns, fitted together with the accepted set, in the units
  /// of the candidate's unknowns.
  Eigen::VectorXd own_coefficients(std::size_t item) const;
  /// Returns the coefficients of a candidate's term, fitted together with the accepted set: one number for
  /// each coefficient of the term. A coefficient is 0 if the model or other candidates contain its column.
  std::vector<double> coefficient_of_each_unknown(std::size_t item) const;
  /// Returns the decrease of the BIC if one candidate alone is added to the model.
  double score_alone(std::size_t item) const;
  /// Returns the p-value of a candidate: the probability that noise alone decreases the BIC as much, times
  /// the number of tested candidates (Bonferroni).
  double p_value(std::size_t item) const;
  /// Returns the p-value of a candidate that is added to `others`. The p-value is 1 if one of these has the
  /// same columns.
  double p_value_beside(std::size_t item, const std::vector<std::size_t>& others) const;
  /// Returns the natural logarithm of the likelihood ratio of held-out runs: the model with an accepted
  /// effect against the model without this effect. Each run is predicted from the other runs
  /// (leave-one-run-out).
  double held_out_evidence(std::size_t item) const;
  /// Returns the alternatives to one accepted effect by a linear estimate; the other accepted effects are
  /// unchanged.
  Alternatives alternatives_to(std::size_t item) const;
  /// Returns the BIC of a set of candidates whose chi^2 is `ratio` times the chi^2 of the accepted set.
  double criterion_of_fit(const std::vector<std::size_t>& items, double ratio) const;
  /// Replaces the accepted effect `item` by the candidate `by`. Returns false and changes nothing if the set
  /// with the replaced effect fails an acceptance test.
  bool replace(std::size_t item, std::size_t by);
  /// Returns the evidence for an accepted effect by a linear estimate: half the increase of the BIC if the
  /// effect is removed. The second form of evidence_for uses other values of the effect's scanned unknowns
  /// (for example a period).
  double evidence_for(std::size_t item) const;
  double evidence_for(std::size_t item, const std::vector<double>& scanned) const;
  /// Returns the other periods that fit as well as the period of an accepted cyclic error (Scanner::aliases).
  /// The other accepted effects are unchanged.
  std::vector<double> aliases_of(std::size_t item) const;
  /// Returns the decrease of the BIC that `general` must have over `simple`, if `simple` is its limit for a
  /// short travel: one of many travels fits better by chance. Otherwise 0.
  double evidence_beyond_limit(std::size_t simple, std::size_t general) const;
  /// Returns the factor by which chi^2 increases if one accepted effect is removed and the other effects are
  /// fitted again.
  double growth_without(std::size_t item) const;
  /// Returns the fraction of chi^2 that remains with one candidate alone in the model, by a linear estimate.
  double share_left(std::size_t item) const;
  /// True if the residual of the model with the accepted effects is noise, by a linear estimate.
  bool linear_down_to_noise() const;

 private:
  /// Scans all candidates beside the accepted ones and selects again, until the set no longer changes.
  void search_beside_chosen();
  /// Excludes the candidates that held-out rows contradict, and those of the same columns.
  void ban_contradicted();
  void scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first = 0);
  /// Searches the thermal responses of the structures (responses.h). Accepted effects that do not depend on a
  /// temperature stay in the model.
  void search_responses();
  /// Returns the number of accepted effects that depend on a temperature.
  std::size_t thermal_items() const;
  /// Searches products of recorded quantities, which the catalogue does not contain: first products of two
  /// quantities, then the best products with a third factor.
  void search_products();
  /// Returns the products of recorded quantities that decrease the BIC most, if each product is added alone.
  std::vector<Product> best_products();
  /// Builds the selection problem from the candidates in the pool.
  void pose_problem();
  /// Returns the index of a candidate in the selection problem; nullopt if the candidate failed a test
  /// (banned).
  std::optional<std::size_t> entry_of(std::size_t item) const;
  void select_again();
  /// Replaces an accepted form of an effect by a simpler form that it contains, unless there is evidence for
  /// the additional terms of the richer form. Among forms with the same columns, simplify() uses the form
  /// nearest to the axis. `share`: the simpler form is used if its decrease of chi^2 is at least this share
  /// of the decrease by the richer form. A `share` above 1 switches this comparison of chi^2 off.
  void simplify(double share = 2);
  /// A term of the number of rows (a creep) whose column is nearly that of a straight line and a reversal
  /// error of its axis, as in one run out and back: names these two instead, which every axis has, unless
  /// there is very strong evidence against them.
  void name_usual_pairs();
  /// Two reversal errors of one axis at one location, or one beside a curve of the axis, can be pieces of one
  /// reversal error that builds up over a travel: between constant points of reversal the travel since a
  /// reversal is a function of position and direction. Names this one effect, alone or beside a straight
  /// line, if the BIC is then lower.
  void join_reversals();
  /// Orders the accepted effects. The effect that lowers the present residual most is first. If the errors of
  /// the readings are correlated, the most significant effect is not always the largest effect.
  void order_by_size();
  /// If the rows have no standard uncertainty u, an acceptance test counts any remaining structure as noise.
  /// For rows without u, name_simplest uses the simplest form that explains nearly the whole decrease of
  /// chi^2, if this form passes the tests.
  void name_simplest();
  /// Returns the limit of a candidate for a short travel: a reversal error that builds up within a short
  /// travel is a backlash. The result has no value if the candidate does not depend on the travel since a
  /// reversal.
  std::optional<std::size_t> limit_of(std::size_t general) const;
  /// True if the term of a candidate depends on this quantity of its axis.
  bool depends_on(std::size_t item, model::SymbolKind kind) const;
  /// Returns the number of candidates that contain the columns of the simpler form `simple` and additional
  /// terms, or have it as a limit.
  double holders_of(std::size_t simple) const;
  void search();
  /// For each axis of which an accepted effect is more than a straight line or a reversal error: adds the
  /// candidates beside a straight line and a reversal error in place of the accepted effects of that axis
  /// alone. A curve through a few positions follows a short cyclic error, and a creep follows a lead error
  /// and a reversal error together: beside them the period of the cyclic error would not be found.
  void search_beside_lines(double from, double to);
  /// True if a candidate is one term that depends on one axis alone: its position, its approach direction,
  /// its travel since a reversal or the number of rows.
  bool is_of_axis_alone(std::size_t item, std::size_t axis) const;
  /// Returns the candidate of one coefficient with the smallest penalty that depends on the axis of `beside`,
  /// at the same location: on its position only or, if `of_direction`, on its approach direction only. The
  /// result has no value if the pool has no such candidate.
  std::optional<std::size_t> most_usual(std::size_t beside, bool of_direction) const;
  /// Reduces the weight of readings whose errors are correlated at one pose, in a run or in time.
  void weigh_correlation();
  void share_poses();
  /// Returns the BIC of the accepted set, including the penalty of the noise model.
  double priced_criterion() const;
  void search_under(const fit::NoiseModel& noise);
  /// Repeats the search for effects and the noise estimate in turn until both converge. The function
  /// settle_noise_from() returns the BIC, including the penalty of the noise model.
  double settle_noise_from(fit::NoiseModel noise);
  /// Returns the accepted effects whose contribution changes from row to row, faster than an instrument
  /// drifts.
  std::vector<std::size_t> quick_ones() const;
  /// In each set-up the measured object may have another position, which affects every reading along a
  /// normal. Returns the noise model with one shift of the measured object for each set-up, if these shifts
  /// decrease the BIC enough; otherwise nullopt. `explained`: noise model of the residual of the model with
  /// all accepted effects.
  std::optional<fit::NoiseModel> touched_anew(const fit::NoiseModel& explained) const;
  /// True if the error that `noise` correlates by run or in time is one common offset of all readings. One
  /// cause in the machine can give all readings a common offset. An instrument that drifts, or that is set up
  /// again, does not give all readings the same offset.
  bool is_one_offset(const fit::NoiseModel& noise) const;
  /// Returns the columns of several candidates side by side, before whitening.
  Eigen::MatrixXd raw_columns(const std::vector<std::size_t>& items) const;
  /// Returns the decrease of chi^2 by an accepted effect whose scanned unknowns have the values `scanned`;
  /// the other accepted effects are unchanged.
  double gain_at(std::size_t item, const std::vector<double>& scanned) const;
  std::vector<std::size_t> without(std::size_t item) const;
  Selection evaluate(const std::vector<std::size_t>& items) const;
  /// Excludes products of recorded quantities that could pass the tests by chance. Chance products depend on
  /// only a few readings, or repeat an effect of the catalogue that failed.
  void ban_hollow_products();
  /// Returns the name of the first acceptance test that an accepted effect fails; empty if the effect passes
  /// all tests.
  std::string failed_test(std::size_t item) const;
  /// Each test returns its failure as text, or an empty text. `gain`: the decrease of chi^2 by the effect.
  std::string failed_on_runs(std::size_t item, double gain) const;
  std::string failed_on_levels(std::size_t item, double gain) const;
  std::string failed_on_positions(std::size_t item, double gain) const;
  std::string failed_between_stations(std::size_t item) const;
  /// Returns the blocks of rows that are held out for an effect: whole runs, or parts of runs for an effect
  /// that acts in single runs.
  std::vector<int> runs_to_hold_out(std::size_t item) const;
  /// Returns the variance of a weighted reading after a fit of the accepted effects; at least 1 if u is
  /// given.
  double variance_of_reading() const;
  /// Returns the decrease of chi^2 by an accepted item on held-out blocks: each block is predicted from the
  /// other blocks. blocks: one index per fit observation.
  double held_out_decrease(std::size_t item, const std::vector<int>& blocks) const;
  /// A division of the fit observations into blocks, and the sum of squares with which the accepted effects
  /// predict each block from the other blocks.
  struct Division {
    std::vector<int> blocks;
    double accepted = 0;
  };
  double held_out_square(const std::vector<std::size_t>& items, const std::vector<int>& blocks) const;
  /// Adds the divisions by position for an effect, except those that are already in the list.
  void add_divisions(std::size_t of, std::vector<Division>& divisions) const;
  /// True if the accepted set with `alternative` in place of `item` predicts held-out runs or positions so
  /// much worse that the likelihood ratio is 20 to 1 against the alternative. `of_item`: the divisions for
  /// `item`.
  bool predicts_worse(std::size_t alternative, std::size_t item, const std::vector<Division>& of_item) const;
  /// Returns what an accepted effect contributes to each reading, beside the free parameters of the model.
  Eigen::VectorXd contribution(std::size_t item) const;
  /// has_input: true if the term of a candidate contains an input of the class `wanted`. shows_in_one_block:
  /// true if one run contains nearly all that an accepted effect explains. If an effect acts in only one run,
  /// the other runs cannot confirm the effect.
  bool has_input(std::size_t item, effects::InputClass wanted) const;
  bool shows_in_one_block(std::size_t item) const;
  /// Returns the reason why a term is larger than on any real machine; empty if the size is plausible.
  std::string too_large(std::size_t item) const;
  /// Returns the reference length or angle for the size of a term. For an angle the reference is the travel
  /// of the rotary axis that drives the angle, deg (0: no such axis). For a length the reference is the reach
  /// of the machine, mm.
  double extent_of(const effects::Candidate& candidate) const;
  /// Returns the largest value of a term whose linear unknown is 1, mm or deg. The maximum is over the fit
  /// rows and along the axis that drives the term.
  double typical_size(const effects::Candidate& candidate, std::size_t linear, std::size_t item) const;
  double largest_value(const effects::Candidate& candidate, std::size_t linear, std::size_t item,
                       const model::States& states) const;
  void accept();
  /// Returns the p-value of the decrease of a residual by these columns: the probability under noise alone,
  /// times the number of candidates.
  double chance_of(std::size_t item, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                   double freedom) const;
  /// The same for the columns of an effect beside other columns, which are fitted too.
  double chance_beside(std::size_t item, const Eigen::MatrixXd& others) const;

  const std::vector<effects::Effect>& effects_;
  std::size_t most_effects_;
  std::function<void(double, const std::string&)> progress_;
  Evidence evidence_;
  const AcceptanceThresholds& thresholds_;  // thresholds of the evidence
  std::vector<ScannedCandidate> list_;
  Scanner scanner_;
  Pool pool_;
  SelectionProblem problem_;
  std::vector<std::size_t> entry_item_, chosen_;
  std::vector<std::vector<std::size_t>> starts_;  // sets of items from which a selection begins too
  std::vector<Contradicted> contradicted_;        // items that held-out rows contradict
  double criterion_ = 0, chi_square_ = 0;
};

}  // namespace vernier::diagnose
