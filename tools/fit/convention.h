// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Returns the precision matrix for these scales: (scale_i scale_j)^-1 precision_ij.
Eigen::SparseMatrix<double> scaled_precision(const Convention& convention, const Eigen::VectorXd& scale);

/// Computes scales by kind. Lengths: 3 x misfit. Angles: 3 x misfit divided by the reach. Set-ups are free,
/// because they contain the rigid motion. Scale of periods and time constants (in a divisor, an exponent or a
/// lag): the nominal value of the parameter. Scale of coefficients with any other unit: the value that moves
/// their degree of freedom by 3 x misfit. A `scale` of the machine file replaces the computed scale. The
/// scales are evaluated at the nominal machine, so they do not depend on the start of the fit.
Convention convention_of(const model::Machine& machine, const model::Measurement& rows,
                         const model::ParameterSet& parameters);

/// Decides again which parameters the readings do not show, at the fitted machine: a tool that was nominally
/// on an axis and is found beside the axis makes the zero of that axis visible. Returns true if the readings
/// show a parameter that counted as unseen. rows: of the fit.
bool see_again(const model::Machine& fitted, const model::Measurement& rows,
               const model::ParameterSet& parameters, Convention& convention);

}  // namespace vernier::fit
