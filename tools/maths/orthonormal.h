// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::maths {

/// Returns the columns after orthonormalisation, one after another. A column is removed if less than the
/// share `least` of its length remains. `kept`: receives the indices of the linearly independent columns.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns, double least, std::vector<std::size_t>* kept);

/// Returns the columns of all parts, one part after another. `rows`: rows of each part.
Eigen::MatrixXd side_by_side(Eigen::Index rows, const std::vector<Eigen::MatrixXd>& parts);

}  // namespace vernier::maths
