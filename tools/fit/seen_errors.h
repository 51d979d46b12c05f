// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>

#include "tools/fit/types.h"

namespace vernier::fit {

/// Size of a machine's errors, as far as its readings show it: of a kind as a whole (lengths or
/// angles, of linear or rotary axes), and of each table relative to the others. All in units of
/// the convention's scales.
///
/// If the lengths of a table, including its squareness, are larger than the others', its angles
/// may be larger by the same factor. A survey with one tool shows only the sum of both. The errors
/// of the good axes are no evidence about a bad axis.
class SeenErrors {
 public:
  /// squares: expected square of each value relative to its neighbours; from_data: share of each
  /// that the readings determine; moved: influence of each on the readings at the convention's
  /// scale, squared.
  SeenErrors(const Convention& convention, const Eigen::VectorXd& squares, const Eigen::VectorXd& from_data,
             const Eigen::VectorXd& moved);

  /// Does the kind's scale follow its observed errors?
  bool seen(int kind) const;
  /// Returns the expected square of an entry of this kind (in that table; -1: none), within the
  /// limits of the convention.
  double variance(int kind, int table) const;

 private:
  struct Seen {
    double squares = 0, determined = 0, entries = 0, moved = 0;
    bool mostly() const;
    double variance() const;
    Seen without(const Seen& other) const;
  };
  static const Seen& of(const std::map<std::pair<int, int>, Seen>& tables, int kind, int table);
  double beside_others(int kind, int table) const;
  double times_larger(int kind, int table) const;

  std::map<int, Seen> kinds_;
  std::map<std::pair<int, int>, Seen> tables_;
  // The same including slopes in statics (squareness). An angle may be hidden there.
  std::map<int, Seen> leaning_kinds_;
  std::map<std::pair<int, int>, Seen> leaning_tables_;
};

}  // namespace vernier::fit
