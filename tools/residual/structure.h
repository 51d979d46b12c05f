// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/residual/types.h"

namespace vernier::residual {

/// Finds where a model fails. failure_picture tests the residual of each kind of observation over the fit
/// rows against every recorded column, products of two columns, order of the rows, runs, repeats,
/// neighbourhood. residual: measured - model, one per observation, mm or deg. The tests weight by 1/u. Each
/// kind of observation has a separate variance. F tests: Seber and Lee, Linear Regression Analysis, 2nd
/// ed., chapter 4; serial correlation: Bartlett's formula.
FailurePicture failure_picture(const model::Machine& machine, const model::Measurement& measurement,
                               const Eigen::VectorXd& residual, const StructureOptions& options = {});

}  // namespace vernier::residual
