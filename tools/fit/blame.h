// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>

#include "tools/fit/settle.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Says why a fit did not converge: the number of readings and of parameters; the combination of parameters
/// along which the last step still moved; the combinations that the readings do not determine; what to do.
/// The estimates and the observability of `result` must be complete. readings: of the fit rows, without those
/// that only determine touched objects. Parts are separated by semicolons, without a final point.
std::string blame_of(const FitResult& result, const Settled& end, std::size_t readings);

}  // namespace vernier::fit
