// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>

#include "tools/fit/types.h"

namespace vernier::fit {

/// Typical size of the errors of a machine, as far as the readings show them. Each kind of error (lengths or
/// angles, of linear or rotary axes) has its own typical size. Each table has a ratio: the size of its errors
/// divided by the size of the errors in the other tables. All sizes of errors are in units of the
/// convention's scales.
///
/// If the length errors of a table (including squareness) are larger than those of the other tables, its
/// angle errors may be larger by the same factor. The reason is that a survey with one tool shows only the
/// sum of length errors and angle errors. The errors of the accurate axes are no evidence about an inaccurate
/// axis.
class SeenErrors {
 public:
  /// Each vector of the constructor has one number for each parameter. `squares`: expected square of each
  /// parameter, relative to its neighbours in the table. `from_data`: share of each parameter that the
  /// readings determine, 0 to 1. `moved`: square of the change of the readings if the parameter changes by
  /// its scale in `convention`.
  SeenErrors(const Convention& convention, const Eigen::VectorXd& squares, const Eigen::VectorXd& from_data,
             const Eigen::VectorXd& moved);

  /// True if the scale of the parameters of this kind follows the errors that were observed.
  bool seen(int kind) const;
  /// Returns the expected square of a parameter of the kind `kind`, within the limits of the convention.
  /// `table`: index of the parameter's table; -1: no table.
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
  // Sums per kind and per table as in `kinds_` and `tables_`, but including slopes in statics (squareness).
  // At a pose with a slope, the readings may not depend on an angle.
  std::map<int, Seen> leaning_kinds_;
  std::map<std::pair<int, int>, Seen> leaning_tables_;
};

}  // namespace vernier::fit
