// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/parameters.h"

namespace vernier::fit {

/// What a weighted Jacobian says about its parameters. Computed on columns scaled to unit length.
struct Observability {
  Eigen::Index rank = 0;
  double condition = 0;  // of the scaled Jacobian, over the identified directions
  /// (J^T W^2 J)^+ over the identified directions, in parameter units; to be multiplied by the variance
  /// factor.
  Eigen::MatrixXd covariance;
  std::vector<char> determined;  // per parameter: no part of it lies in an unidentified direction
  /// The identified combinations that the data see least: singular value over the largest, and the parameters
  /// that take part, largest part first. At most three, weakest first.
  struct Weak {
    double ratio = 0;
    std::vector<std::size_t> parts;
  };
  std::vector<Weak> weakest;
  /// Combinations that the data cannot see; indices of the parameters that take part, largest part first.
  std::vector<std::vector<std::size_t>> unidentifiable;
};

/// Directions with a scaled singular value below this share of the largest count as unidentified: far above
/// what rounding leaves of an exact dependence (1e-8) and below any direction that real data determine.
inline constexpr double kUnseenShare = 1e-5;

/// normal: J^T W^2 J, n x n. Above 200 parameters by pivoted Cholesky
/// and inverse iteration, the whole eigen-decomposition only where the rank is not plain from that. tool.
Observability observe(const Eigen::MatrixXd& normal, double cutoff = kUnseenShare);

}  // namespace vernier::fit
