// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/propose/scan.h"
#include "tools/diagnose/propose/selection.h"

namespace vernier::diagnose {

/// Returns the quantities on which a term depends besides positions and constants: dir of an axis,
/// an input, t ...
std::set<std::pair<int, std::size_t>> drivers_of(const model::Machine& machine,
                                                 const effects::Candidate& candidate);

/// The best of all candidates. The columns of the candidates are stored side by side, so that sets of
/// candidates can be compared.
class Pool {
 public:
  struct Item {
    Scored scored;
    Eigen::MatrixXd columns;        // after projection on the complement of what the model absorbs
    std::vector<std::size_t> kept;  // index of the linear unknown of each column
    bool banned = false;            // failed an acceptance test
    std::string why_not;
  };

  Pool(const Evidence& evidence, const Scanner& scanner);

  /// Adds the most promising candidates: those with the largest gain minus penalty, and the best candidate of
  /// every effect. Scanned values are refined first.
  void add(const std::vector<Scored>& scored, const Eigen::MatrixXd& beside);

  /// Removes all entries.
  void clear() {
    items_.clear();
    keys_.clear();
  }

  /// The entries that are not banned, as a problem of selection. `items`: item of each entry.
  SelectionProblem problem(std::vector<std::size_t>& items) const;
  /// Returns the selection problem of the given items, excluded or not.
  SelectionProblem problem_of(const std::vector<std::size_t>& items) const;

  std::size_t size() const { return items_.size(); }
  const Item& operator[](std::size_t i) const { return items_[i]; }
  const effects::Candidate& candidate(std::size_t i) const;
  void ban(std::size_t i, std::string why) {
    items_[i].banned = true;
    items_[i].why_not = std::move(why);
  }

  /// Returns the columns of several items side by side.
  Eigen::MatrixXd columns(const std::vector<std::size_t>& items) const;
  /// A term from the search, without a name in the catalogue.
  bool is_custom(std::size_t i) const { return candidate(i).choice.effect == &effects::custom_effect(); }
  /// Returns the share of the squares of an item's columns that lies in the span of another's.
  double common_share(std::size_t item, std::size_t other) const;
  /// Returns the effective number of readings that support an item: squared sum over the sum of squares of
  /// its columns' squares.
  double witnesses(std::size_t item) const;
  /// True if two items have the same effect (or cause in the catalogue), driving axis and inputs. Two items
  /// with equal effect on the readings count as the same cause.
  bool same_cause(std::size_t a, std::size_t b) const;
  /// True if two items span the same columns (all but a thousandth of their squares).
  bool same_columns(std::size_t a, std::size_t b) const;
  /// True if `general` has more unknowns than `special`, and depends on all that `special` depends on.
  bool is_richer(std::size_t general, std::size_t special) const;
  /// True if `general` is richer than `special` and contains its columns (all but 2 % of their squares).
  bool contains(std::size_t general, std::size_t special) const;
  /// True if two items depend on the same kinds of quantities. Positions, count of rows and travel since a
  /// reversal do not count. If the columns of two such items are also equal, the items are two forms of one
  /// term.
  bool same_kind(std::size_t a, std::size_t b) const;
  /// Returns the penalty of a candidate for the number of tested candidates (twice the logarithm of their
  /// number).
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
