// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::results {

/// Returns the residuals of the fit rows in groups. The groups are the words of a column, or the values of a
/// numeric column (at most 50 values): an approach direction, an axis, an input, or a column that the machine
/// file does not use. Each column has one entry {column, differ_p, each: [{value, readings: [{reading, unit,
/// n, mean, rms}]}]}. The unit is um, or urad for rotations. `differ_p`: p-value of a one-way F test of the
/// group means. The value `differ_p` is the smallest p-value over the kinds of readings, multiplied by the
/// number of kinds (null: too few readings). `residual`: one value per observation, mm or deg. Throws
/// InputError if no file has the column.
nlohmann::ordered_json group_table(const model::Machine& machine, const model::Measurement& measurement,
                                   const Eigen::VectorXd& residual, const std::vector<std::string>& columns);

}  // namespace vernier::results
