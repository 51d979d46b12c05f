// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

const char* origin_name(Origin origin);

/// Fits the parameters of the machine by weighted least squares to the fit rows. A weighted residual is
/// residual / u (u = 1 if u is absent). Parameters that the data do not determine are as near to nominal as
/// possible, in units of each parameter's scale (convention of tools/fit/convention.h). The result of the fit
/// does not depend on its start, the order of the rows or the stages. The member `observability` of the
/// result names the combinations of parameters that the data cannot distinguish. The standard uncertainty of
/// a parameter comes from u, times sqrt(chi^2 / dof) if that exceeds 1. If the readings have no u,
/// the standard uncertainty of a parameter comes from the residual (GUM 5.2). If the data give
/// little information on a parameter, its standard uncertainty comes from its scale. Throws
/// InputError if there is no parameter to fit or no reading.
FitResult fit(const model::Machine& machine, const model::Measurement& measurement,
              const FitOptions& options = {});

}  // namespace vernier::fit
