// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Inverses of large matrices: less than half of the products that solving for each unit vector needs.
#include <Eigen/Core>
#include <optional>

namespace vernier::maths {

/// Replaces the lower triangle of `lower` by that of its inverse. The upper triangle is not read or changed.
/// The diagonal must not have zeros. Block by block, as LAPACK's dtrtri.
void invert_lower(Eigen::Ref<Eigen::MatrixXd> lower);

/// Returns r^T r, symmetric, for the lower triangle r of `lower`. The upper triangle is not read.
Eigen::MatrixXd square_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower);

/// Returns the inverse of a symmetric positive definite matrix, of which only the lower triangle is read.
/// nullopt: rounding makes the matrix indefinite.
std::optional<Eigen::MatrixXd> inverse_of_positive(const Eigen::MatrixXd& matrix);

/// Returns a b for a product that is symmetric but for rounding: half of the products.
Eigen::MatrixXd symmetric_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace vernier::maths
