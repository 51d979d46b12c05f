// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <vector>

#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Whitened columns of a candidate at one point of its search grid, without the part that the free parameters
/// of the model explain.
struct ProjectedPoint {
  std::vector<double> scanned;
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd norms;  // norm of each column before the projection
};

/// Whitened sines and cosines of a cyclic error at successive frequencies, without the part that the free
/// parameters of the model explain. The frequency k has the columns 2k and 2k + 1.
struct ProjectedWaves {
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd squares;  // sum of squares of each column before the projection
};

/// Stores the projected columns of candidates between two scans. A search scans the same candidates again for
/// each set of accepted effects. Only the projection on the complement of the accepted effects is computed
/// again. The columns of long records exceed the memory limit and are computed again for each scan.
class ProjectedColumns {
 public:
  /// Deletes all stored columns if the whitening of the evidence has changed. Call renew() before each scan.
  void renew(const Evidence& evidence, std::size_t candidates);

  /// Returns the stored grid points of a candidate, or null if they are not stored.
  const std::vector<ProjectedPoint>* points(std::size_t candidate) const;
  /// Returns the stored sines and cosines of a candidate, or null if they are not stored.
  const ProjectedWaves* waves(std::size_t candidate) const;
  /// True if the store has room for this number of values.
  bool has_room(Eigen::Index numbers) const { return numbers <= room_; }
  /// Stores all grid points of a candidate if the store has room. Different threads may call keep() at the
  /// same time for different candidates.
  void keep(std::size_t candidate, std::vector<ProjectedPoint> points);
  /// Stores the sines and cosines of a candidate. Before the call, has_room() must be true for them.
  const ProjectedWaves& keep(std::size_t candidate, ProjectedWaves waves);

 private:
  std::size_t revision_ = 0;  // Evidence::revision() of the stored columns
  std::atomic<Eigen::Index> room_ = 0;
  std::vector<std::vector<ProjectedPoint>> points_;
  std::vector<ProjectedWaves> waves_;
};

}  // namespace vernier::diagnose
