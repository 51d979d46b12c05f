// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::maths {

/// Columns made orthonormal one after the other; those with less than `least` of their length left are
/// dropped. `kept`: the ones that stay.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns, double least, std::vector<std::size_t>* kept);

}  // namespace vernier::maths
