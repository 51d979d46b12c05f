// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Returns corrected axis positions for rows that touch an object (`same`, `on`). At these positions the tool
/// point is exactly on the object, with the object at its best estimate for this machine. Rows that touch no
/// object keep their positions. The axes stopped at the touch, so that the recorded positions contain the
/// error of the touch. A function of the recorded positions with a large slope would explain this error. The
/// returned positions do not contain the error of the touch. A true error function of the positions hardly
/// changes by this small difference.
std::vector<Column> touched_positions(const Machine& machine, const Measurement& measurement);

/// Returns the extent (diagonal of the box, mm) of the tool points in the given rows.
double extent_of_points(const Machine& machine, const Measurement& measurement,
                        const std::vector<std::size_t>& rows);

}  // namespace vernier::model
