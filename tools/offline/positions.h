// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// A CSV of positions with the axis columns corrected: all other cells, columns and comments as they stand.
/// Its columns are those of a measurement or path file (axes, inputs, motion; sense and speed count as
/// given). A file without axis columns may name targets in workpiece coordinates instead: x y z, and with
/// them rx ry rz (rotation vector) or i j k (tool direction); the nominal chain's back solution then gives
/// the axes, which are put in front. Throws InputError with file, line and word; LimitNotMet where a target
/// cannot be reached. tool.
std::string corrected_positions(const std::string& text, const std::string& file, const model::States& at,
                                Corrector& corrector);

}  // namespace vernier::offline
