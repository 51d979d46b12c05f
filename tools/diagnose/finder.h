// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/enumerate.h"
#include "tools/diagnose/evidence.h"
#include "tools/diagnose/pool.h"
#include "tools/diagnose/products.h"
#include "tools/diagnose/scan.h"
#include "tools/diagnose/selection.h"

namespace vernier::diagnose {

/// What could stand in the place of an accepted effect. All are items of the pool.
struct Rivals {
  std::vector<std::size_t> close;  // other causes that fit nearly as well, best first
  std::vector<std::size_t> same;   // the same columns from the same kinds of quantities
  double distance = 1e300;         // of the best other cause
  std::optional<std::size_t> best;
};

/// Searches the candidates of one fitted machine for the set that explains its residual, and keeps of it what
/// passes every test of acceptance. All on the linearised problem; nothing is fitted again. tool.
class Finder {
 public:
  /// `fitted`: the machine at its best fit. `progress`: share of the whole diagnosis, and what is being done.
  Finder(const model::Machine& fitted, const model::Measurement& measurement,
         const std::vector<effects::Effect>& effects, std::size_t most_effects,
         std::function<void(double, const std::string&)> progress, const DiagnoseThresholds& thresholds = {});
  Finder(const Finder&) = delete;
  Finder& operator=(const Finder&) = delete;

  /// Catalogue first; products of quantities where what is left is more than noise.
  void find();

  /// Accepted items of the pool, the one that explains most first.
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  const Pool& pool() const { return pool_; }
  const Evidence& evidence() const { return evidence_; }
  /// How the errors of the readings are correlated beside the accepted effects.
  fit::NoiseModel noise() const;
  const std::vector<ScannedCandidate>& candidates() const { return list_; }

  /// Coefficients of an item's columns within the accepted set, in the unit of its unknowns.
  Eigen::VectorXd own_coefficients(std::size_t item) const;
  /// The same, one for each coefficient of its term: 0 for those whose column the model or others hold.
  std::vector<double> coefficient_of_each_unknown(std::size_t item) const;
  /// Decrease of the BIC that an item brings alone.
  double score_alone(std::size_t item) const;
  /// Chance of such a gain on noise alone, times the number of candidates looked at.
  double p_value(std::size_t item) const;
  /// The same beside the accepted items; 1 for one that says what they say.
  double p_value_beside(std::size_t item) const;
  /// Likelihood ratio (natural logarithm) of runs left out in turn, with an accepted item and without it,
  /// each predicted from the others.
  double held_out_evidence(std::size_t item) const;
  /// What fits nearly as well in the place of an accepted item, the others given.
  Rivals rivals_of(std::size_t item) const;
  /// Other periods that do as well as an accepted item's own (Scanner::aliases), the other items given.
  std::vector<double> aliases_of(std::size_t item) const;
  /// How many times chi^2 grows where an accepted item is left out, the others fitted again.
  double growth_without(std::size_t item) const;
  /// Does what the accepted effects leave look like noise, by the linear estimate?
  bool linear_down_to_noise() const;

 private:
  void scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first = 0);
  /// Beyond the catalogue: products of recorded quantities, pairs first, then a third factor on the best.
  void search_products();
  /// The products that lower the criterion most, alone.
  std::vector<Product> best_products();
  /// The pool's entries as they stand, ready for a selection.
  void pose_problem();
  /// Position of an item in the problem; nothing for one that is banned.
  std::optional<std::size_t> entry_of(std::size_t item) const;
  void select_again();
  /// A form that holds a simpler one is taken only where what it has more is evidence by itself; of forms
  /// with the same columns the one nearest to the axis.
  /// share: of what a richer form explains from which on the simpler one stands whatever the rest is worth;
  /// above 1: none does.
  void simplify(double share = 2);
  /// The effect first that takes most off the residual as it stands, and so on. What is most certain beside
  /// correlated errors need not be large.
  void order_by_size();
  /// Without u, where any structure left counts as noise: the simplest form that does nearly all, where it
  /// passes the tests.
  void name_simplest();
  /// How many entries hold a simpler one and more.
  double holders_of(std::size_t simple) const;
  void search();
  /// Readings whose errors are correlated, at one pose, in a run or in time, count for less.
  void weigh_correlation();
  void share_poses();
  /// The criterion of selection with the price of the noise model.
  double priced_criterion() const;
  void search_under(const fit::NoiseModel& noise);
  /// Search and noise in turn until both stand still. Returns the criterion with the noise model's own price.
  double settle_noise_from(fit::NoiseModel noise);
  /// Of the chosen those that move from row to row, not only as slowly as an instrument drifts.
  std::vector<std::size_t> quick_ones() const;
  /// What is touched may stand elsewhere in each set-up, which no reading along a normal is free of: that as
  /// the instrument's part of a rival, where it takes more away than it costs. explained: what is left beside
  /// all that was chosen.
  std::optional<fit::NoiseModel> touched_anew(const fit::NoiseModel& explained) const;
  /// Is what is correlated by run or in time under this model one offset of all readings? A common
  /// cause does that, and no instrument that is set up anew or drifts.
  bool is_one_offset(const fit::NoiseModel& noise) const;
  /// Unwhitened columns of several items side by side.
  Eigen::MatrixXd raw_columns(const std::vector<std::size_t>& items) const;
  std::vector<std::size_t> without(std::size_t item) const;
  Selection evaluate(const std::vector<std::size_t>& items) const;
  /// Bans products that would pass the tests by chance: those that a few readings carry, and those that do
  /// what an effect of the catalogue does which failed.
  void ban_hollow_products();
  /// The first test of acceptance that an accepted item fails; empty where it passes all.
  std::string failed_test(std::size_t item) const;
  /// Does one run hold nearly all that an accepted item explains? The other runs cannot tell of it then.
  /// Does an accelerometer feature stand in its term?
  bool is_learned(std::size_t item) const;
  bool shows_in_one_block(std::size_t item) const;
  /// Is the term larger than any machine shows it?
  std::string too_large(std::size_t item) const;
  /// What the size of a term is judged by: travel of the rotary axis that drives an angle, deg (0: none
  /// does); reach of the machine for lengths, mm.
  double extent_of(const effects::Candidate& candidate) const;
  /// Largest value over the fit rows and along the axis that drives it that a linear unknown of 1 gives its
  /// term, mm or deg.
  double typical_size(const effects::Candidate& candidate, std::size_t linear, std::size_t item) const;
  double largest_value(const effects::Candidate& candidate, std::size_t linear, std::size_t item,
                       const model::States& states) const;
  void accept();
  /// Chance on noise alone of what columns take away of a residual, times the number of candidates.
  double chance_of(std::size_t item, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                   double freedom) const;

  std::size_t most_effects_;
  std::function<void(double, const std::string&)> progress_;
  Evidence evidence_;
  const AcceptanceThresholds& thresholds_;  // the evidence's
  std::vector<ScannedCandidate> list_;
  Scanner scanner_;
  Pool pool_;
  SelectionProblem problem_;
  std::vector<std::size_t> entry_item_, chosen_;
  double criterion_ = 0, chi_square_ = 0;
};

}  // namespace vernier::diagnose
