// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/families.h"
#include "tools/diagnose/propose/projected.h"

namespace vernier::diagnose {

/// Scores candidates without keeping their columns. The scalar product of a direction and a whitened column
/// is that of the direction, multiplied by the transposed whitening, and the column before whitening: a sum
/// over the rows, function of the row, times the sum of the response times the direction over the
/// observations of this row. The second factor depends on the location only, the first on the family only. A
/// tracker survey has three observations in a row, and tens of locations for each function: the scalar
/// products cost a small part of those with explicit columns. The norms and grams of the columns need no
/// whitened columns either, while the errors of the observations are independent; else they are computed once
/// for each whitening.
class ByRows {
 public:
  explicit ByRows(const Evidence& evidence) : evidence_(evidence) {}

  /// Prepares a scan of the given locations with the columns `known` (accepted columns, and the residual).
  /// Deletes what is stored if the whitening of the evidence has changed. Call prepare() before each scan.
  void prepare(const std::vector<std::size_t>& places, const Eigen::MatrixXd& known, std::size_t candidates);

  /// True if nothing of a candidate is left to compute for the known columns.
  bool is_complete(std::size_t candidate) const;
  /// Computes what is missing. Different threads may call complete() at the same time for different
  /// candidates.
  void complete(std::size_t candidate, const effects::Candidate& effect, const RowFunctions& functions);
  /// Returns the grid points of a candidate with norms and grams, without columns.
  const ProjectedBatch& batch(std::size_t candidate) const { return *batches_[candidate]; }
  /// Returns the scalar products of the known columns (rows) with the columns of a candidate.
  Eigen::MatrixXd products(std::size_t candidate) const { return products_.products(prepared_, candidate); }

 private:
  struct Place {
    Eigen::MatrixXd absorbed;  // sums by row of the model's columns; empty: no room, computed for each use
    Eigen::MatrixXd known;     // of the known columns
  };
  ProjectedBatch measured(std::size_t candidate, const effects::Candidate& effect,
                          const RowFunctions& functions) const;

  const Evidence& evidence_;
  std::size_t revision_ = 0;
  double own_ = 1;             // standard deviation of the observations, in units of u
  Eigen::MatrixXd absorbed_;   // the model's columns after the transposed whitening
  std::vector<Place> places_;  // by the index of Evidence::places
  std::vector<std::optional<ProjectedBatch>> batches_;
  KnownProducts products_;
  std::vector<std::size_t> prepared_;
};

}  // namespace vernier::diagnose
