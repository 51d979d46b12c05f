// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/model/measurement.h"

namespace vernier::results {

/// One line a reading: `row` (data rows counted from 1 over all files), `observation` (x y z rx ry rz length
/// d), `value`, `prediction`, `residual` (value less prediction) and `u` (empty where none is given), mm or
/// deg as `unit` says; then role, run, file and line. residual: one per observation. tool.
std::string residual_csv(const model::Measurement& measurement, const Eigen::VectorXd& residual);

}  // namespace vernier::results
