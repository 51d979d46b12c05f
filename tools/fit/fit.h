// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

const char* origin_name(Origin origin);

/// Weighted least squares on the fit rows: residual / u (1 where u is absent), and the convention of
/// tools/fit/convention.h: what the data leave open is as near to nominal as it can be, in units of each
/// parameter's scale. The answer does not depend on the start, the order of the rows or the stages. What the
/// data cannot separate is named in `observability`. Standard uncertainty: from u, times sqrt(chi^2 / dof)
/// where that exceeds 1; without u from the residual (GUM 5.2); where data say little, from the scale. Throws
/// InputError where there is nothing to fit. tool.
FitResult fit(const model::Machine& machine, const model::Measurement& measurement,
              const FitOptions& options = {});

}  // namespace vernier::fit
