// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Returns the rows of a measurement for a machine that declares more of the columns as inputs. Rows with an
/// empty cell in a new input column are excluded, and their number is counted.
Measurement rebind(const Measurement& measurement, const Machine& from, const Machine& to);

}  // namespace vernier::model
