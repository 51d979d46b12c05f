// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::maths {

/// Returns the columns, made orthonormal one after another. Columns with less than `least` of their length
/// remaining are dropped. `kept`: indices of the linearly independent columns.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns, double least, std::vector<std::size_t>* kept);

}  // namespace vernier::maths
