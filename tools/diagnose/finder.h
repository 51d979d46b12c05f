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
#include "tools/diagnose/propose/scan.h"
#include "tools/diagnose/propose/selection.h"

namespace vernier::diagnose {

/// Alternatives to an accepted effect. All are items of the pool.
struct Alternatives {
  std::vector<std::size_t> close;  // other causes that fit nearly as well, best first
  std::vector<std::size_t> same;   // the same columns from the same kinds of quantities
  double distance = 1e300;         // of the best other cause
  std::optional<std::size_t> best;
};

/// Searches the candidates of one fitted machine for the set that explains its residual. Keeps the
/// items that pass every acceptance test. All on the linearised problem, without a new fit. tool.
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

  /// Accepted items of the pool, the one that explains most is first.
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  const Pool& pool() const { return pool_; }
  const Evidence& evidence() const { return evidence_; }
  /// Correlation of the errors of the readings beside the accepted effects.
  fit::NoiseModel noise() const;
  const std::vector<ScannedCandidate>& candidates() const { return list_; }

  /// Coefficients of an item's columns within the accepted set, in the unit of its unknowns.
  Eigen::VectorXd own_coefficients(std::size_t item) const;
  /// The same, one for each coefficient of its term. 0 for coefficients whose column the model or
  /// other items contain.
  std::vector<double> coefficient_of_each_unknown(std::size_t item) const;
  /// Decrease of the BIC that an item brings alone.
  double score_alone(std::size_t item) const;
  /// Probability of such a gain by noise alone, times the number of tested candidates.
  double p_value(std::size_t item) const;
  /// The same beside the accepted items; 1 for an item with the same columns as an accepted one.
  double p_value_beside(std::size_t item) const;
  /// Likelihood ratio (natural logarithm) of runs held out in turn, with an accepted item and
  /// without it. Each run is predicted from the others.
  double held_out_evidence(std::size_t item) const;
  /// Alternatives that fit nearly as well as an accepted item, with the other items unchanged.
  Alternatives alternatives_to(std::size_t item) const;
  /// Other periods that fit as well as an accepted item's own (Scanner::aliases), with the other
  /// items unchanged.
  std::vector<double> aliases_of(std::size_t item) const;
  /// Factor by which chi^2 increases if an accepted item is excluded and the others are fitted
  /// again.
  double growth_without(std::size_t item) const;
  /// Is the residual beside the accepted effects noise, by the linear estimate?
  bool linear_down_to_noise() const;

 private:
  void scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first = 0);
  /// Searches beyond the catalogue: products of recorded quantities, pairs first, then a third
  /// factor on the best pairs.
  void search_products();
  /// The products that lower the criterion most, alone.
  std::vector<Product> best_products();
  /// Prepares the present entries of the pool for a selection.
  void pose_problem();
  /// Position of an item in the problem; nullopt for a banned item.
  std::optional<std::size_t> entry_of(std::size_t item) const;
  void select_again();
  /// A form that contains a simpler form is accepted only if its additional terms are evidence by
  /// themselves. Of forms with the same columns, the one nearest to the axis is used. share: if
  /// the simpler form reaches this share of what a richer form explains, it is used whatever the
  /// rest explains. Above 1: never.
  void simplify(double share = 2);
  /// Orders the effects: first the effect that lowers the present residual most, and so on. Beside
  /// correlated errors, the most certain effect need not be large.
  void order_by_size();
  /// Without u, any remaining structure counts as noise. Then the simplest form that explains
  /// nearly all is used, if it passes the tests.
  void name_simplest();
  /// Number of entries that contain a simpler form and additional terms.
  double holders_of(std::size_t simple) const;
  void search();
  /// Reduces the weight of readings with correlated errors: at one pose, in a run or in time.
  void weigh_correlation();
  void share_poses();
  /// The criterion of selection including the penalty of the noise model.
  double priced_criterion() const;
  void search_under(const fit::NoiseModel& noise);
  /// Alternates search and noise estimate until both converge. Returns the criterion including the
  /// noise model's own penalty.
  double settle_noise_from(fit::NoiseModel noise);
  /// Returns the chosen items that change from row to row, and not only as slowly as an instrument
  /// drifts.
  std::vector<std::size_t> quick_ones() const;
  /// The measured object may have another position in each set-up, which affects every reading
  /// along a normal. Returns that as the instrument's part of an alternative, if it removes more
  /// than its penalty. explained: the residual beside all chosen items.
  std::optional<fit::NoiseModel> touched_anew(const fit::NoiseModel& explained) const;
  /// Is the error that is correlated by run or in time under this model one offset of all
  /// readings? A common cause does that. An instrument that is set up anew or drifts does not.
  bool is_one_offset(const fit::NoiseModel& noise) const;
  /// Unwhitened columns of several items side by side.
  Eigen::MatrixXd raw_columns(const std::vector<std::size_t>& items) const;
  std::vector<std::size_t> without(std::size_t item) const;
  Selection evaluate(const std::vector<std::size_t>& items) const;
  /// Bans products that would pass the tests by chance: products that depend on a few readings,
  /// and products that repeat a failed effect of the catalogue.
  void ban_hollow_products();
  /// Returns the first acceptance test that an accepted item fails; empty if it passes all.
  std::string failed_test(std::size_t item) const;
  /// Does one run contain nearly all that an accepted item explains? Then the other runs cannot
  /// confirm it. Does its term contain an accelerometer feature?
  bool is_learned(std::size_t item) const;
  bool shows_in_one_block(std::size_t item) const;
  /// Is the term larger than on any real machine?
  std::string too_large(std::size_t item) const;
  /// Reference for the size of a term: travel of the rotary axis that drives an angle, deg (0: no
  /// such axis); reach of the machine for lengths, mm.
  double extent_of(const effects::Candidate& candidate) const;
  /// Largest value of a term with its linear unknown at 1, over the fit rows and along the axis
  /// that drives it, mm or deg.
  double typical_size(const effects::Candidate& candidate, std::size_t linear, std::size_t item) const;
  double largest_value(const effects::Candidate& candidate, std::size_t linear, std::size_t item,
                       const model::States& states) const;
  void accept();
  /// Probability that noise alone explains the decrease of a residual by columns, times the number
  /// of candidates.
  double chance_of(std::size_t item, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                   double freedom) const;

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
