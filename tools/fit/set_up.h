// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns half the diagonal of the box of the fit rows' tool points, mm, at least 10. An angle moves the
/// points by the lever reach_of().
double reach_of(const model::Machine& machine, const model::Measurement& rows);

/// Returns the machine with its free BaseShifts fitted to the fit rows. No other value of the machine
/// changes. tool.
model::Machine set_up(const model::Machine& machine, const model::Measurement& rows);

/// Fits the BaseShifts of the machine to all rows, for any orientation of the instrument. Starts are the
/// measuring frame, the file's own set-up and the best rigid motion of the measured points. If the residuals
/// still exceed ten times their uncertainty, all 24 orientations of the axes are tried. Use set_up_anywhere
/// for readings of a known machine. A survey that will be fitted uses set_up(), because a rotated set-up can
/// hide swapped columns of a flat survey. tool.
model::Machine set_up_anywhere(const model::Machine& machine, const model::Measurement& measured);

}  // namespace vernier::fit
