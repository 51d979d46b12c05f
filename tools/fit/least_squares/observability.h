// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/parameters.h"

namespace vernier::fit {

/// Result of an analysis which parameters a weighted Jacobian determines, and how well. The analysis uses the
/// columns of the Jacobian, scaled to unit length.
struct Observability {
  Eigen::Index rank = 0;
  double condition = 0;  // condition number of the scaled Jacobian over the identified directions
  /// Covariance of the parameters in their units, without the variance factor: (J^T W^2 J)^+ over the
  /// identified directions.
  Eigen::MatrixXd covariance;
  std::vector<char>
      determined;  // per parameter: true if the parameter has no part in an unidentified direction
  /// A combination of parameters that the data identify, but only weakly. `ratio`: its singular value divided
  /// by the largest singular value. `parts`: indices of the participating parameters, largest part first. The
  /// list has at most three weak combinations, the weakest first.
  struct Weak {
    double ratio = 0;
    std::vector<std::size_t> parts;
  };
  std::vector<Weak> weakest;
  /// Combinations of parameters that the data do not determine. Each combination lists the indices of its
  /// parameters, largest part first.
  std::vector<std::vector<std::size_t>> unidentifiable;
};

/// Limit for a scaled singular value as a share of the largest. A direction below the limit counts as
/// unidentified. The limit for unidentified directions is far above the rounding error of an exact dependence
/// (1e-8) and below any direction that real data determine.
inline constexpr double kUnseenShare = 1e-5;

/// `normal`: the normal matrix J^T W^2 J, n x n. Above 200 parameters, observe() uses pivoted Cholesky and
/// inverse iteration. The full eigen-decomposition follows only if the pivoted Cholesky method gives no clear
/// rank.
Observability observe(const Eigen::MatrixXd& normal, double cutoff = kUnseenShare);

}  // namespace vernier::fit
