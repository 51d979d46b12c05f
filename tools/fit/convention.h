// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// precision for these scales: (scale_i scale_j)^-1 precision_ij.
Eigen::SparseMatrix<double> scaled_precision(const Convention& convention, const Eigen::VectorXd& scale);

/// Scales by kind: lengths 3 x misfit, angles as much over the reach, set-ups free (rigid motion is theirs),
/// periods and time constants (what stands in a divisor, an exponent or a lag) their own nominal value,
/// coefficients of any other unit what moves their degree of freedom by as much. `scale` of the machine file
/// takes the place of any. Evaluated at the nominal machine: the same whatever the start. tool.
Convention convention_of(const model::Machine& machine, const model::Measurement& rows,
                         const model::ParameterSet& parameters);

}  // namespace vernier::fit
