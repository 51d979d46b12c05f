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

/// Another cause in place of an accepted cause.
struct Alternative {
  std::size_t item = 0;  // of the pool
  double distance = 0;   // its BIC minus that of the accepted set
};

/// Alternatives to an accepted effect.
struct Alternatives {
  std::vector<Alternative> other;  // other causes, by distance
  std::vector<std::size_t> same;   // items with the same columns from the same kinds of quantities

  /// Returns the items within a distance, in their order.
  std::vector<std::size_t> within(double distance) const;
};

/// Searches the candidates of one fitted machine for the set that explains its residual. Keeps the items that
/// pass every acceptance test. Finder works on the linearised problem and makes no new fit.
class Finder {
 public:
  /// `fitted`: the machine at its best fit. `progress`: share of the whole diagnosis, and the
  /// current step.
  Finder(const model::Machine& fitted, const model::Measurement& measurement,
         const std::vector<effects::Effect>& effects, std::size_t most_effects,
         std::function<void(double, const std::string&)> progress, const DiagnoseThresholds& thresholds = {});
  Finder(const Finder&) = delete;
  Finder& operator=(const Finder&) = delete;

  /// Searches the catalogue first, then products of quantities if the residual exceeds the noise.
  void find();

  /// Returns the accepted items of the pool; the item that explains most is first.
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  const Pool& pool() const { return pool_; }
  const Evidence& evidence() const { return evidence_; }
  /// Returns the correlation of the errors of the readings beside the accepted effects.
  fit::NoiseModel noise() const;
  const std::vector<ScannedCandidate>& candidates() const { return list_; }

  /// Returns the coefficients of an item's columns within the accepted set, in the unit of its unknowns.
  Eigen::VectorXd own_coefficients(std::size_t item) const;
  /// Returns one coefficient of an item within the accepted set for each coefficient of its term. The value
  /// is 0 for a coefficient whose column the model or other items contain.
  std::vector<double> coefficient_of_each_unknown(std::size_t item) const;
  /// Returns the decrease of the BIC by an item alone.
  double score_alone(std::size_t item) const;
  /// Returns the probability that noise alone gives such a decrease of the BIC, times the number of tested
  /// candidates.
  double p_value(std::size_t item) const;
  /// Returns the p-value of an item beside the accepted items; 1 for an item with the same columns as an
  /// accepted item.
  double p_value_beside(std::size_t item) const;
  /// Returns the likelihood ratio (natural logarithm) of held-out runs: with an accepted item to without this
  /// item. Each run is predicted from the other runs.
  double held_out_evidence(std::size_t item) const;
  /// Returns alternatives to an accepted item, by the linear estimate; the other items are unchanged.
  Alternatives alternatives_to(std::size_t item) const;
  /// Returns the BIC of a set of items whose fit has `ratio` times the chi^2 of the accepted set's fit.
  double criterion_of_fit(const std::vector<std::size_t>& items, double ratio) const;
  /// Replaces an accepted item. Returns false, and changes nothing, if the new set fails an acceptance test.
  bool replace(std::size_t item, std::size_t by);
  /// Returns the evidence for an accepted item: half the increase of the BIC without it, by the linear
  /// estimate. The second form: with its scanned unknowns at other values.
  double evidence_for(std::size_t item) const;
  double evidence_for(std::size_t item, const std::vector<double>& scanned) const;
  /// Returns other periods that fit as well as the period of an accepted item (Scanner::aliases), with the
  /// other items unchanged.
  std::vector<double> aliases_of(std::size_t item) const;
  /// Returns the factor by which chi^2 increases if an accepted item is excluded and the others are fitted
  /// again.
  double growth_without(std::size_t item) const;
  /// True if the residual beside the accepted effects is noise, by the linear estimate.
  bool linear_down_to_noise() const;

 private:
  void scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first = 0);
  /// Searches the thermal responses of the structures (responses.h) beside the effects without temperature.
  void search_responses();
  /// Returns the number of accepted items that depend on a temperature.
  std::size_t thermal_items() const;
  /// Searches beyond the catalogue: products of recorded quantities, first pairs, then a third factor on the
  /// best pairs.
  void search_products();
  /// Returns the products that decrease the BIC most, each product alone.
  std::vector<Product> best_products();
  /// Prepares the present entries of the pool for a selection.
  void pose_problem();
  /// Returns the position of an item in the problem; nullopt for a banned item.
  std::optional<std::size_t> entry_of(std::size_t item) const;
  void select_again();
  /// A form that contains a simpler form is accepted only if there is evidence for its additional terms
  /// themselves. Among forms with the same columns, the form nearest to the axis is used. share: if the
  /// decrease of chi^2 by the simpler form is at least this share of the decrease by a richer form, the
  /// simpler form is used. A share above 1 never selects the simpler form in this way.
  void simplify(double share = 2);
  /// Orders the effects: first the effect that lowers the present residual most, and so on. If the readings
  /// have correlated errors, the most significant effect is not always the largest effect.
  void order_by_size();
  /// If the rows have no standard uncertainty u, any remaining structure counts as noise. In this case
  /// name_simplest uses the simplest form that explains nearly the whole decrease of chi^2, if the form
  /// passes the tests.
  void name_simplest();
  /// Returns the number of entries that contain a simpler form and additional terms.
  double holders_of(std::size_t simple) const;
  void search();
  /// Reduces the weight of readings with correlated errors: at one pose, in a run or in time.
  void weigh_correlation();
  void share_poses();
  /// The criterion of selection including the penalty of the noise model.
  double priced_criterion() const;
  void search_under(const fit::NoiseModel& noise);
  /// Repeats search and noise estimate in turn until both converge. Returns the BIC, including the penalty of
  /// the noise model.
  double settle_noise_from(fit::NoiseModel noise);
  /// Returns the chosen items that change from row to row, and not only as slowly as an instrument
  /// drifts.
  std::vector<std::size_t> quick_ones() const;
  /// The measured object may have another position in each set-up, which affects every reading along a
  /// normal. Returns this position as the instrument's part of an alternative, if it decreases the BIC.
  /// explained: the residual beside all chosen items.
  std::optional<fit::NoiseModel> touched_anew(const fit::NoiseModel& explained) const;
  /// True if the error that `noise` correlates by run or in time is one offset of all readings. One common
  /// cause can have the effect of an offset of all readings. An instrument that is set up again or drifts
  /// does not make one offset of all readings.
  bool is_one_offset(const fit::NoiseModel& noise) const;
  /// Returns the unwhitened columns of several items side by side.
  Eigen::MatrixXd raw_columns(const std::vector<std::size_t>& items) const;
  /// Returns the decrease of chi^2 by an accepted item with its scanned unknowns at these values, beside the
  /// other items.
  double gain_at(std::size_t item, const std::vector<double>& scanned) const;
  std::vector<std::size_t> without(std::size_t item) const;
  Selection evaluate(const std::vector<std::size_t>& items) const;
  /// Excludes products that would pass the tests by chance: products that depend on a few readings, and
  /// products that repeat a failed effect of the catalogue.
  void ban_hollow_products();
  /// Returns the first acceptance test that an accepted item fails; empty if the item passes all tests.
  std::string failed_test(std::size_t item) const;
  /// Returns the variance of a weighted reading beside the accepted set; at least 1 if u is given.
  double variance_of_reading() const;
  /// Returns the decrease of chi^2 by an accepted item on held-out blocks: each block is predicted from the
  /// other blocks. blocks: one index per fit observation.
  double held_out_decrease(std::size_t item, const std::vector<int>& blocks) const;
  /// True if the accepted set with `alternative` in place of `item` predicts held-out runs or positions so
  /// much worse that the likelihood ratio is 20 to 1 against the alternative.
  bool predicts_worse(std::size_t alternative, std::size_t item) const;
  /// has_input: true if the term of an item contains an input of a class. shows_in_one_block: true if
  /// one run contains nearly all that an accepted item explains. In this case the other runs cannot confirm
  /// the item.
  bool has_input(std::size_t item, effects::InputClass wanted) const;
  bool shows_in_one_block(std::size_t item) const;
  /// Returns the reason why a term is larger than on any real machine; empty if it is not.
  std::string too_large(std::size_t item) const;
  /// Returns the reference for the size of a term. Angles: travel of the rotary axis that drives the angle,
  /// deg (0: no such axis); lengths: reach of the machine, mm.
  double extent_of(const effects::Candidate& candidate) const;
  /// Returns the largest value of a term with its linear unknown at 1, over the fit rows and along the axis
  /// that drives the term, mm or deg.
  double typical_size(const effects::Candidate& candidate, std::size_t linear, std::size_t item) const;
  double largest_value(const effects::Candidate& candidate, std::size_t linear, std::size_t item,
                       const model::States& states) const;
  void accept();
  /// Returns the probability that noise alone explains the decrease of a residual by columns, times the
  /// number of candidates.
  double chance_of(std::size_t item, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                   double freedom) const;

  const std::vector<effects::Effect>& effects_;
  std::size_t most_effects_;
  std::function<void(double, const std::string&)> progress_;
  Evidence evidence_;
  const AcceptanceThresholds& thresholds_;  // of the evidence
  std::vector<ScannedCandidate> list_;
  Scanner scanner_;
  Pool pool_;
  SelectionProblem problem_;
  std::vector<std::size_t> entry_item_, chosen_;
  double criterion_ = 0, chi_square_ = 0;
};

}  // namespace vernier::diagnose
