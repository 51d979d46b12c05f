// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/parameters.h"

namespace vernier::fit {

/// Information of a weighted Jacobian on its parameters. It is computed on columns scaled to unit
/// length.
struct Observability {
  Eigen::Index rank = 0;
  double condition = 0;  // of the scaled Jacobian, over the identified directions
  /// (J^T W^2 J)^+ over the identified directions, in parameter units; to be multiplied by the variance
  /// factor.
  Eigen::MatrixXd covariance;
  std::vector<char>
      determined;  // per parameter: true if the parameter has no part in an unidentified direction
  /// The identified combinations that the data determine least: singular value divided by the
  /// largest, and the participating parameters, largest part first. At most three combinations,
  /// weakest first.
  struct Weak {
    double ratio = 0;
    std::vector<std::size_t> parts;
  };
  std::vector<Weak> weakest;
  /// Combinations that the data do not determine; indices of the participating parameters, largest
  /// part first.
  std::vector<std::vector<std::size_t>> unidentifiable;
};

/// Directions with a scaled singular value below this share of the largest count as unidentified.
/// The limit is far above the rounding error of an exact dependence (1e-8) and below any direction
/// that real data determine.
inline constexpr double kUnseenShare = 1e-5;

/// normal: J^T W^2 J, n x n. Above 200 parameters, pivoted Cholesky and inverse iteration are
/// used. The full eigen-decomposition follows only if they do not give a clear rank. tool.
Observability observe(const Eigen::MatrixXd& normal, double cutoff = kUnseenShare);

}  // namespace vernier::fit
