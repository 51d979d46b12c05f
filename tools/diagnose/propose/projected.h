// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Candidate at one point of its search grid. Its columns are neighbouring columns of a ProjectedBatch.
struct GridPoint {
  std::size_t candidate = 0;    // index of the candidate in the scanned list
  std::vector<double> scanned;  // values of the candidate's scanned unknowns
  Eigen::Index first = 0, count = 0;
};

/// Whitened columns of grid points side by side, without the part that the free parameters of the model
/// explain. The batch also contains what every scan needs from the columns alone.
struct ProjectedBatch {
  std::vector<GridPoint> points;
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd norms;            // norm of each column before the projection
  std::vector<Eigen::MatrixXd> grams;  // for each point, the scalar products of its projected columns
};

/// Projects whitened columns on the orthogonal complement of the model's free parameters.
ProjectedBatch project(const Evidence& evidence, std::vector<GridPoint> points, Eigen::MatrixXd columns);

/// Whitened sines and cosines of a cyclic error at successive frequencies, without the part that the free
/// parameters of the model explain. The frequency k has the columns 2k and 2k + 1.
struct ProjectedWaves {
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd squares;  // sum of squares of each column before the projection
};

/// Scalar products of accepted columns with the columns of the stored batches. A column that an earlier scan
/// used is not multiplied again.
class KnownProducts {
 public:
  /// Deletes all products.
  void clear() { known_.clear(); }
  /// Prepares the products of `columns` with `batches` batches. Returns the numbers of the columns.
  std::vector<std::size_t> prepare(const Eigen::MatrixXd& columns, std::size_t batches);
  /// Returns the column with a number that prepare() returned.
  const Eigen::VectorXd& column(std::size_t number) const { return known_[number].column; }
  /// Returns the positions in `prepared` of the columns that have no products with the batch `at` yet.
  std::vector<Eigen::Index> missing(const std::vector<std::size_t>& prepared, std::size_t at) const;
  /// Stores the products (rows) of the columns at these positions. Different threads may call store() at the
  /// same time for different batches.
  void store(const std::vector<std::size_t>& prepared, const std::vector<Eigen::Index>& positions,
             std::size_t at, const Eigen::MatrixXd& products);
  /// Returns the scalar products of the prepared columns (rows) with the columns of the batch `at`.
  Eigen::MatrixXd products(const std::vector<std::size_t>& prepared, std::size_t at) const;

 private:
  struct Known {
    Eigen::VectorXd column;
    std::vector<Eigen::RowVectorXd> of_batch;  // empty: not yet computed
  };
  std::vector<Known> known_;
};

/// Stores the projected columns of candidates between two scans. A search scans the same candidates again for
/// each set of accepted effects. Only the scalar products with the accepted effects are computed again. The
/// columns of long records exceed the memory limit and are computed again for each scan.
class ProjectedColumns {
 public:
  /// Deletes all stored columns if the whitening of the evidence has changed. Call renew() before each scan.
  void renew(const Evidence& evidence, std::size_t candidates);

  /// True if the columns of a candidate are in one of the stored batches.
  bool holds(std::size_t candidate) const { return held_[candidate] != 0; }
  /// Returns the stored batches. The columns of a candidate are all in one batch.
  const std::vector<ProjectedBatch>& batches() const { return batches_; }
  /// Returns the scalar products of accepted columns with the stored batches.
  KnownProducts& products() { return products_; }
  /// Returns the scalar products of prepared columns (rows) with the columns of the batch `at`. Computes and
  /// stores what is missing. Different threads may call products_of() at the same time for different batches.
  Eigen::MatrixXd products_of(const std::vector<std::size_t>& prepared, std::size_t at);
  /// Returns the stored sines and cosines of a candidate, or null if they are not stored.
  const ProjectedWaves* waves(std::size_t candidate) const;
  /// True if an empty store has room for this number of values.
  static bool have_room(Eigen::Index numbers);
  /// Returns the number of values for which the store has room.
  Eigen::Index room() const { return room_; }
  /// True if the store has room for this number of values.
  bool has_room(Eigen::Index numbers) const { return numbers <= room_; }
  /// Stores a batch if the store has room. The batch must contain all grid points of its candidates.
  void keep(ProjectedBatch batch);
  /// Stores the sines and cosines of a candidate. Before the call, has_room() must be true for them.
  const ProjectedWaves& keep(std::size_t candidate, ProjectedWaves waves);

 private:
  std::size_t revision_ = 0;  // Evidence::revision() of the stored columns
  Eigen::Index room_ = 0;
  std::vector<ProjectedBatch> batches_;
  KnownProducts products_;
  std::vector<char> held_;  // for each candidate
  std::vector<ProjectedWaves> waves_;
};

}  // namespace vernier::diagnose
