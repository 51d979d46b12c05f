// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <vector>

#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Whitened columns of a candidate at one point of its grid, without the part that the model absorbs.
struct ProjectedPoint {
  std::vector<double> scanned;
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd norms;  // of each column before the projection
};

/// Whitened sines and cosines of a wave at successive frequencies (columns 2k and 2k + 1), without the part
/// that the model absorbs.
struct ProjectedWaves {
  Eigen::MatrixXd columns;
  Eigen::RowVectorXd squares;  // of each column before the projection
};

/// Keeps projected columns between scans. A search scans the same candidates beside each set of its effects,
/// and computes only the projection beside the effects anew. Long records exceed the limit of the memory and
/// are computed anew each time.
class ProjectedColumns {
 public:
  /// Forgets all columns if the whitening of the evidence has changed. Call before each scan.
  void renew(const Evidence& evidence, std::size_t candidates);

  /// Returns the points of a candidate, or null.
  const std::vector<ProjectedPoint>* points(std::size_t candidate) const;
  /// Returns the waves of a candidate, or null.
  const ProjectedWaves* waves(std::size_t candidate) const;
  /// True if there is room for as many numbers.
  bool has_room(Eigen::Index numbers) const { return numbers <= room_; }
  /// Keeps all points of a candidate if there is room. Different threads may call keep() at the same time for
  /// different candidates.
  void keep(std::size_t candidate, std::vector<ProjectedPoint> points);
  /// Keeps the waves of a candidate, for which there is room (has_room).
  const ProjectedWaves& keep(std::size_t candidate, ProjectedWaves waves);

 private:
  std::size_t revision_ = 0;  // of the evidence
  std::atomic<Eigen::Index> room_ = 0;
  std::vector<std::vector<ProjectedPoint>> points_;
  std::vector<ProjectedWaves> waves_;
};

}  // namespace vernier::diagnose
