// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::results {

/// Returns the residuals of the fit rows in groups: by the words of a column, or by the values of a number
/// column (at most 50): an approach direction, an axis, an input, or a column that the machine file does not
/// use. Each column has one entry {column, differ_p, each: [{value, readings: [{reading, unit, n, mean,
/// rms}]}]}; um, urad for rotations. differ_p: one-way F test of the means, the smallest over the kinds of
/// readings times their number (null: too few readings). residual: mm or deg, one per observation. Throws
/// InputError for a column that no file has.
nlohmann::ordered_json group_table(const model::Machine& machine, const model::Measurement& measurement,
                                   const Eigen::VectorXd& residual, const std::vector<std::string>& columns);

}  // namespace vernier::results
