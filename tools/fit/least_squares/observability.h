// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/parameters.h"

namespace vernier::fit {

/// Shows which parameters a weighted Jacobian determines, and how well. Observability is computed on columns
/// scaled to unit length.
struct Observability {
  Eigen::Index rank = 0;
  double condition = 0;  // of the scaled Jacobian, over the identified directions
  /// (J^T W^2 J)^+ over the identified directions, in parameter units; to be multiplied by the variance
  /// factor.
  Eigen::MatrixXd covariance;
  std::vector<char>
      determined;  // per parameter: true if the parameter has no part in an unidentified direction
  /// The identified combination of parameters that the data determine least. Contains the singular value
  /// divided by the largest, and the participating parameters, largest part first. There are at most three
  /// such combinations, weakest first.
  struct Weak {
    double ratio = 0;
    std::vector<std::size_t> parts;
  };
  std::vector<Weak> weakest;
  /// Combinations that the data do not determine; indices of the participating parameters, largest
  /// part first.
  std::vector<std::vector<std::size_t>> unidentifiable;
};

/// A direction counts as unidentified if its scaled singular value is below this share of the largest. The
/// limit is far above the rounding error of an exact dependence (1e-8) and below any direction that real data
/// determine.
inline constexpr double kUnseenShare = 1e-5;

/// normal: J^T W^2 J, n x n. Above 200 parameters, observe() uses pivoted Cholesky and inverse iteration. The
/// full eigen-decomposition follows only if they give no clear rank.
Observability observe(const Eigen::MatrixXd& normal, double cutoff = kUnseenShare);

}  // namespace vernier::fit
