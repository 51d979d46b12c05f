// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Returns the precision matrix of a convention for the scales `scale`: the elements are (scale_i scale_j)^-1
/// precision_ij.
Eigen::SparseMatrix<double> scaled_precision(const Convention& convention, const Eigen::VectorXd& scale);

/// Returns the convention of a fit: the scale (plausible difference from nominal) of each parameter, computed
/// by kind of parameter. The scale of a length is 3 x misfit. The scale of an angle is 3 x misfit divided by
/// the reach. Parameters of a set-up have no limit, because a set-up contains the rigid motion. The scale of
/// a period or a time constant (in a divisor, an exponent or a lag) is the nominal value of the parameter.
/// The scale of a coefficient with any other unit is the value that moves its degree of freedom by 3 x
/// misfit. A `scale` in the machine file replaces the computed scale of a parameter. The scales are evaluated
/// at the nominal machine. The scales therefore do not depend on the start of the fit.
Convention convention_of(const model::Machine& machine, const model::Measurement& rows,
                         const model::ParameterSet& parameters);

/// Decides again, with the fitted machine, which parameters the readings do not determine. Example: the
/// readings do not determine the zero of a rotary axis if the tool is nominally on this axis. If the fit
/// finds the tool at a distance from the axis, the readings determine the zero. Returns true if the readings
/// determine a parameter that counted as not determined. rows: of the fit.
bool see_again(const model::Machine& machine, const Eigen::VectorXd& point, const model::Measurement& rows,
               const model::ParameterSet& parameters, Convention& convention);

}  // namespace vernier::fit
