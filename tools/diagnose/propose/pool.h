// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/propose/scan.h"
#include "tools/diagnose/propose/selection.h"

namespace vernier::diagnose {

/// Returns the quantities on which a term depends, except positions and constants: the approach direction of
/// an axis, an input, the time and others.
std::set<std::pair<int, std::size_t>> drivers_of(const model::Machine& machine,
                                                 const effects::Candidate& candidate);

/// True if one of the quantities changes in time, at any position: an input, the time, the number of rows or
/// the run. `drivers`: from drivers_of().
bool change_in_time(const std::set<std::pair<int, std::size_t>>& drivers);

/// True if motions at two locations move the readings in the same way: the cosine between the responses of
/// the readings exceeds ShapeThresholds::moves_alike.
bool moves_alike(const Evidence& evidence, const effects::DofPlace& a, const effects::DofPlace& b);

/// The most promising candidates of a search. The columns of all candidates are stored together, so that sets
/// of candidates can be compared.
class Pool {
 public:
  struct Item {
    Scored scored;
    Eigen::MatrixXd columns;        // columns after projection on the orthogonal complement of the columns of
                                    // the model's free parameters
    std::vector<std::size_t> kept;  // index of the linear unknown of each column
    bool banned = false;            // the candidate failed an acceptance test
    std::string why_not;
  };

  Pool(const Evidence& evidence, const Scanner& scanner);

  /// Adds the most promising of the scored candidates: those with the largest decrease of chi^2 minus
  /// penalty, and the best candidate of every effect. Scanned values (for example a period) are refined
  /// before a candidate is added.
  void add(const std::vector<Scored>& scored, const Eigen::MatrixXd& beside);

  /// Removes all candidates from the pool.
  void clear() {
    items_.clear();
    keys_.clear();
  }

  /// Returns the selection problem of the candidates that did not fail an acceptance test. `items`: receives
  /// the index in the pool for each entry of the problem.
  SelectionProblem problem(std::vector<std::size_t>& items) const;
  /// Returns the selection problem of the given candidates, including candidates that failed a test.
  SelectionProblem problem_of(const std::vector<std::size_t>& items) const;

  std::size_t size() const { return items_.size(); }
  const Item& operator[](std::size_t i) const { return items_[i]; }
  const effects::Candidate& candidate(std::size_t i) const;
  void ban(std::size_t i, std::string why) {
    items_[i].banned = true;
    items_[i].why_not = std::move(why);
  }

  /// Returns the columns of several candidates side by side.
  Eigen::MatrixXd columns(const std::vector<std::size_t>& items) const;
  /// Returns the period of an item in the unit of its axis; nullopt if the item has no period.
  std::optional<double> period_of(std::size_t i) const;
  /// True if a candidate is a term of the product search, without a name in the catalogue.
  bool is_custom(std::size_t i) const { return candidate(i).choice.effect == &effects::custom_effect(); }
  /// True if the candidate is one term that depends on the position of one axis and on nothing else.
  bool is_function_of_an_axis(std::size_t i) const;
  /// Returns the share of the sum of squares of one candidate's columns that is in the span of another
  /// candidate's columns.
  double common_share(std::size_t item, std::size_t other) const;
  /// Returns the effective number of readings that support a candidate. If s is the sum of squares of the
  /// columns in one reading, the number is (sum of s)^2 / (sum of s^2).
  double witnesses(std::size_t item) const;
  /// True if two candidates have the same effect (or cause in the catalogue), the same driving axis and the
  /// same inputs. Two candidates with the same effect on the readings also count as the same cause.
  bool same_cause(std::size_t a, std::size_t b) const;
  /// True if the columns of two candidates span the same space (all but a thousandth of their squares).
  bool same_columns(std::size_t a, std::size_t b) const;
  /// True if the candidate `general` has more unknowns than `special` and depends on all quantities on which
  /// `special` depends.
  bool is_richer(std::size_t general, std::size_t special) const;
  /// True if the catalogue marks only the candidate `rare` as rare, or if only this candidate is a jump
  /// between runs or a term without a name.
  bool is_rarer(std::size_t rare, std::size_t usual) const;
  /// True if the candidate `general` is richer than `special` and its columns contain the columns of
  /// `special` (all but 2 % of their squares).
  bool contains(std::size_t general, std::size_t special) const;
  /// True if two candidates depend on the same kinds of quantities. The function
  /// same_kind() ignores positions, the row number and the travel since a reversal. If two candidates also
  /// have equal columns, they are two forms of one term.
  bool same_kind(std::size_t a, std::size_t b) const;
  /// Returns the penalty of a candidate for the number of tested candidates (twice the logarithm of their
  /// number).
  double penalty(const Scored& scored) const;

 private:
  static bool is_rare(const effects::Choice& choice);
  std::string place_key(const Scored& scored) const;

  const Evidence& evidence_;
  const PoolThresholds& thresholds_;
  const PoolExtent& extent_;
  const Scanner& scanner_;
  effects::AxisPlaces axes_;
  std::vector<Item> items_;
  std::set<std::string> keys_;
};

}  // namespace vernier::diagnose
