// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// A CSV of positions with the axis columns corrected; all other cells, columns and comments are not changed.
/// Its columns are those of a measurement or path file (axes, inputs, motion; direction and speed are used as
/// given). A file without axis columns may contain targets in workpiece coordinates instead: x y z,
/// optionally with rx ry rz (rotation vector) or i j k (tool direction). The inverse kinematics of the
/// nominal chain then gives the axes, which are written in front. Throws InputError with file, line and word;
/// LimitNotMet if a target cannot be reached. tool.
std::string corrected_positions(const std::string& text, const std::string& file, const model::States& at,
                                Corrector& corrector);

}  // namespace vernier::offline
