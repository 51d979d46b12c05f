// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>

#include "tools/fit/types.h"

namespace vernier::fit {

/// How large a machine's errors are, as far as its readings show them: a kind as a whole (lengths or angles,
/// of linear or rotary axes), and each table beside the others. All in units of the convention's scales.
///
/// A table whose lengths, its squareness with them, are larger than the others' may have angles as much
/// larger: a survey with one tool sees only their sum, and what is seen of the good axes is no evidence about
/// a bad one's.
class SeenErrors {
 public:
  /// squares: of each value as expected beside its neighbours; from_data: share of each that the readings
  /// determine; moved: what each moves the readings by at the convention's scale, squared.
  SeenErrors(const Convention& convention, const Eigen::VectorXd& squares, const Eigen::VectorXd& from_data,
             const Eigen::VectorXd& moved);

  /// The kind's scale follows what is seen of it.
  bool seen(int kind) const;
  /// Expected square of an entry of this kind (in that table; -1: none), within what the convention allows.
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
  // The same with slopes that stand in statics (squareness): where an angle's may hide.
  std::map<int, Seen> leaning_kinds_;
  std::map<std::pair<int, int>, Seen> leaning_tables_;
};

}  // namespace vernier::fit
