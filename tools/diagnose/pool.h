// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/scan.h"
#include "tools/diagnose/selection.h"

namespace vernier::diagnose {

/// What a term depends on besides positions and constants: dir of an axis, an input, t ...
std::set<std::pair<int, std::size_t>> drivers_of(const model::Machine& machine,
                                                 const effects::Candidate& candidate);

/// The best of all candidates, with their columns side by side, so that sets of them can be compared.
class Pool {
 public:
  struct Item {
    Scored scored;
    Eigen::MatrixXd columns;        // after projection on the complement of what the model absorbs
    std::vector<std::size_t> kept;  // which linear unknowns the columns are
    bool banned = false;            // failed a test of acceptance
    std::string why_not;
  };

  Pool(const Evidence& evidence, const Scanner& scanner);

  /// Puts the most promising ones in: those with most gain less cost, and the best of every effect. Scanned
  /// values are refined first.
  void add(const std::vector<Scored>& scored, const Eigen::MatrixXd& beside);

  /// Takes all out again.
  void clear() {
    items_.clear();
    keys_.clear();
  }

  /// The entries that are not banned, as a problem of selection; `items`: which item each entry is.
  SelectionProblem problem(std::vector<std::size_t>& items) const;
  /// The same of given items, banned or not.
  SelectionProblem problem_of(const std::vector<std::size_t>& items) const;

  std::size_t size() const { return items_.size(); }
  const Item& operator[](std::size_t i) const { return items_[i]; }
  const effects::Candidate& candidate(std::size_t i) const;
  void ban(std::size_t i, std::string why) {
    items_[i].banned = true;
    items_[i].why_not = std::move(why);
  }

  /// Columns of several items side by side.
  Eigen::MatrixXd columns(const std::vector<std::size_t>& items) const;
  /// A term that the search made; it has no name in the catalogue.
  bool is_custom(std::size_t i) const { return candidate(i).choice.effect == &effects::custom_effect(); }
  /// Share of the squares of an item's columns that lies in the span of another's.
  double common_share(std::size_t item, std::size_t other) const;
  /// How many readings carry an item: squared sum over the sum of squares of its columns' squares.
  double witnesses(std::size_t item) const;
  /// Effect (or the cause that the catalogue names), driving axis and inputs are the same: no different
  /// cause.
  bool same_cause(std::size_t a, std::size_t b) const;
  /// Do two items span the same columns (all but a thousandth of their squares)?
  bool same_columns(std::size_t a, std::size_t b) const;
  /// Does `general` have more unknowns than `special`, depend on all that `special` depends on, and hold its
  /// columns (all but 2 % of their squares)?
  bool contains(std::size_t general, std::size_t special) const;
  /// Do both depend on the same kinds of quantities (positions, count of rows and travel since a reversal do
  /// not count)? If their columns are the same too, they are two ways to say one thing.
  bool same_kind(std::size_t a, std::size_t b) const;
  /// How much a candidate costs for having been one of many (twice the logarithm of their number).
  double penalty(const Scored& scored) const;

 private:
  std::string place_key(const Scored& scored) const;

  const Evidence& evidence_;
  const PoolThresholds& thresholds_;
  const Scanner& scanner_;
  effects::AxisPlaces axes_;
  std::vector<Item> items_;
  std::set<std::string> keys_;
};

}  // namespace vernier::diagnose
