// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

const char* origin_name(Origin origin);

/// Fits the machine by weighted least squares on the fit rows with residual / u (1 if u is absent). By the
/// convention of tools/fit/convention.h, parameters that the data do not determine are as near to nominal as
/// possible, in units of each parameter's scale. The result does not depend on the start, the order of the
/// rows or the stages. `observability` names the combinations that the data cannot distinguish. Standard
/// uncertainty of a parameter: from u, times sqrt(chi^2 / dof) if that exceeds 1; without u from the residual
/// (GUM 5.2); from the scale if the data give little information. Throws InputError if the fit has no
/// parameter or no reading.
FitResult fit(const model::Machine& machine, const model::Measurement& measurement,
              const FitOptions& options = {});

}  // namespace vernier::fit
