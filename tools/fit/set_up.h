// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Half the diagonal of the box of the fit rows' tool points, mm, and 10 at least: an angle moves them by
/// that much.
double reach_of(const model::Machine& machine, const model::Measurement& rows);

/// The machine with its free BaseShifts fitted to the fit rows and nothing else changed. tool.
model::Machine set_up(const model::Machine& machine, const model::Measurement& rows);

/// The same to all rows, whatever way round the instrument stands: besides the measuring frame and the file's
/// own set-up the best rigid motion of the measured points is a start, and where the readings then still are
/// off by ten times their uncertainty all 24 ways in which the axes can lie. For readings of a machine that
/// is known; a survey that is to be fitted keeps set_up(), since a turned set-up can hide swapped columns of
/// a flat survey. tool.
model::Machine set_up_anywhere(const model::Machine& machine, const model::Measurement& measured);

}  // namespace vernier::fit
