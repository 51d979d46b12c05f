// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Terms of a candidate in the fit rows, per unit of its linear unknowns, at every point of its search grid.
/// A reading changes by the response of the reading to a motion at the location of the term, times the
/// function of the term in the row of the reading.
struct RowFunctions {
  std::vector<std::vector<double>> points;  // grid points: values of the scanned unknowns
  Eigen::Index unknowns = 0;                // number of linear unknowns
  std::vector<Eigen::MatrixXd> of_term;     // for each term: a row for each fit row. The columns of the
                                            // grid points are side by side, one for each linear unknown.
};

/// Families of candidates: the candidates of a family have the same row functions, and differ only in their
/// locations. A search computes the functions of a family once, not again for each location.
class Families {
 public:
  explicit Families(const std::vector<ScannedCandidate>& candidates) : candidates_(candidates) {}

  /// Assigns the candidates to families that were added to the list since the last call.
  void extend();
  std::size_t size() const { return families_.size(); }
  /// Returns the indices of the candidates of a family, in increasing order.
  const std::vector<std::size_t>& members(std::size_t family) const { return families_[family].members; }

  /// Returns the functions of a family. They are stored if there is room. Different threads may call
  /// functions() at the same time for different families, each with its own ColumnMaker.
  std::shared_ptr<const RowFunctions> functions(std::size_t family, ColumnMaker& maker);

 private:
  struct Family {
    std::vector<std::size_t> members;
    std::shared_ptr<const RowFunctions> stored;  // null: not stored
  };
  const std::vector<ScannedCandidate>& candidates_;
  std::size_t assigned_ = 0;  // number of candidates that belong to a family
  std::map<std::string, std::map<std::vector<std::vector<double>>, std::size_t>> known_;  // by terms and grid
  std::vector<Family> families_;
  std::atomic<Eigen::Index> room_ =
      64'000'000;  // numbers that may still be stored: 512 MB, for 10 000 poses of a robot
};

/// Returns every combination of the values of several lists.
std::vector<std::vector<double>> grid_points(const std::vector<std::vector<double>>& lists);

}  // namespace vernier::diagnose
