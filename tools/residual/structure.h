// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/residual/types.h"

namespace vernier::residual {

/// Finds where a model fails. The function failure_picture tests the residual of each kind of observation
/// over the fit rows. The function failure_picture tests the dependence on every recorded column, products of
/// two columns, order of the rows, runs, repeats and neighbourhood. `residual`: measured - model, one value
/// per observation, mm or deg. The tests weight the residual by 1/u. Each kind of observation has its own
/// variance in the tests. The F tests are those of Seber and Lee, Linear Regression Analysis, 2nd ed.,
/// chapter 4. Serial correlation is treated with Bartlett's formula.
FailurePicture failure_picture(const model::Machine& machine, const model::Measurement& measurement,
                               const Eigen::VectorXd& residual, const StructureOptions& options = {});

}  // namespace vernier::residual
