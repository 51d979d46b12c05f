// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// Corrects the axis columns of a CSV file with positions. All other cells, columns and comments are not
/// changed. The first line of the output states whether the positions are corrected or converted back. If the
/// input file has a line that states the opposite, this line is removed. The columns are those of a
/// measurement or path file (axes, inputs, motion). Direction and speed are used without change. A file
/// without axis columns may contain targets in workpiece coordinates: x y z, optionally with rx ry rz
/// (rotation vector) or i j k (tool direction). For targets in workpiece coordinates, the inverse kinematics
/// of the nominal chain gives the axis positions, and the axis columns are written first. Throws InputError
/// with file, line and word if the file is not valid. Throws LimitNotMet if the machine cannot reach a
/// target.
///
/// `place`: position of the targets' coordinate system in workpiece coordinates, mm. Throws InputError if
/// `place` is given although the file has axis columns.
std::string corrected_positions(const std::string& text, const std::string& file, const model::States& at,
                                Corrector& corrector, const std::optional<Eigen::Isometry3d>& place = {});

}  // namespace vernier::offline
