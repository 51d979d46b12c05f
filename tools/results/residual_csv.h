// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/model/measurement.h"

namespace vernier::results {

/// Returns CSV with one line per reading: `row` (number of the data row over all files, from 1),
/// `observation` (its kind), `value`, `prediction`, `residual` (value minus prediction) and `u` (empty if not
/// given), mm or deg as `unit` states; then role, run, file and line. `residual`: one value per observation.
std::string residual_csv(const model::Measurement& measurement, const Eigen::VectorXd& residual);

}  // namespace vernier::results
