// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// The same rows for a machine that declares more of their columns as inputs; rows with an empty cell in a
/// column that is now an input are excluded and counted. tool.
Measurement rebind(const Measurement& measurement, const Machine& from, const Machine& to);

}  // namespace vernier::model
