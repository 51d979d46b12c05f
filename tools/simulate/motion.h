// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/simulate/path.h"

namespace vernier::simulate {

/// Returns the motion state of a machine at every tick of a path. Positions and inputs between the rows of
/// the path are interpolated linearly. Recorded motion columns are also interpolated; a direction keeps the
/// value of its row. All quantities of the motion that are not recorded are computed from the positions:
///   v      slope of the path's segment
///   a      change of segment speed at each row, over the time between the segments' middles; linear between
///          the rows, the first and last row as their neighbours
///   dir    sign of the last motion, held at rest; 0 before the first
///   since  travel since the last reversal; a long way before the first
///   feed   speed over the linear axes; curv  |v x a| / |v|^3 over the linear axes
/// Throws InputError if the path does not contain an axis of the machine.
model::States path_states(const Path& path, const model::Machine& machine, const Ticks& ticks);

}  // namespace vernier::simulate
