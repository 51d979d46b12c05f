// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Returns the positions of each axis at which the tool point would be exactly on the object that the row
/// touched (`same`, `on`), with the objects at their best estimates for this machine. Other rows keep their
/// positions. The axes stopped where the tool touched, so that recorded positions contain the error of the
/// touch: any function of them that is steep enough explains it. The returned positions do not contain it;
/// they differ by the size of the error, which no true function of the positions sees.
std::vector<Column> touched_positions(const Machine& machine, const Measurement& measurement);

/// Extent (diagonal, mm) of the points at which the tool was in these rows.
double extent_of_points(const Machine& machine, const Measurement& measurement,
                        const std::vector<std::size_t>& rows);

}  // namespace vernier::model
