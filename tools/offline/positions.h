// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// Corrects the axis columns of a CSV of positions; all other cells, columns and comments are not changed.
/// The first line states whether the positions are corrected or converted back; a line that states the
/// opposite is omitted. The columns are those of a measurement or path file (axes, inputs, motion; direction
/// and speed are used as given). A file without axis columns may contain targets in workpiece coordinates: x
/// y z, optionally with rx ry rz (rotation vector) or i j k (tool direction). For such targets the inverse
/// kinematics of the nominal chain gives the axes; their columns are written first. Throws InputError with
/// file, line and word; LimitNotMet if a target cannot be reached.
///
/// place: of the targets' coordinates in workpiece coordinates, mm. Throws InputError if a workpiece position
/// is given and the file has axis columns.
std::string corrected_positions(const std::string& text, const std::string& file, const model::States& at,
                                Corrector& corrector, const std::optional<Eigen::Isometry3d>& place = {});

}  // namespace vernier::offline
