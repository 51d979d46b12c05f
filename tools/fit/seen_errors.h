// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>

#include "tools/fit/types.h"

namespace vernier::fit {

/// Typical size of a machine's errors, as far as its readings show it. Each kind of error (lengths or angles,
/// of linear or rotary axes) has a size. Each table has a ratio: its size divided by the size of the other
/// tables. All sizes are in units of the convention's scales.
///
/// If the lengths of a table, including its squareness, are larger than those of the other tables, its angles
/// may be larger by the same factor. A survey with one tool shows only the sum of lengths and angles. The
/// errors of the good axes are no evidence about a bad axis.
class SeenErrors {
 public:
  /// Each vector has one number for each parameter. squares: expected square of the parameter, relative to
  /// its neighbours in the table. from_data: share of the parameter that the readings determine, 0 to 1.
  /// moved: square of the change of the readings if the parameter changes by its scale in `convention`.
  SeenErrors(const Convention& convention, const Eigen::VectorXd& squares, const Eigen::VectorXd& from_data,
             const Eigen::VectorXd& moved);

  /// True if the scale of this kind follows its observed errors.
  bool seen(int kind) const;
  /// Returns the expected square of an entry of this kind, within the limits of the convention. table: the
  /// table of the entry; -1: no table.
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
  // The same including slopes in statics (squareness). At such a pose the readings may not depend on an
  // angle.
  std::map<int, Seen> leaning_kinds_;
  std::map<std::pair<int, int>, Seen> leaning_tables_;
};

}  // namespace vernier::fit
