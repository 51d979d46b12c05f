// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::kinematics {

/// Reads one state from a user's text: "X=100,Y=-20,dirX=1,T=25,feed=1000". Names: axes, inputs,
/// v/a/dir/since of an axis, feed, curv, t, nx ny nz, run (a label). Base units (mm, deg, mm/s ...).
/// Quantities without a value are 0. Inputs without a value are at their reference. Throws InputError with
/// the word.
model::States state_at(const model::Machine& machine, const std::string& words);

/// Returns the machine with one of its tools by name, or with a tool given as "X,Y,Z" (mm, beyond the end of
/// the chain). An empty text returns the machine unchanged. Throws InputError.
model::Machine tooled(const model::Machine& machine, const std::string& tool);

/// Parses numbers separated by commas. `counts` lists the allowed numbers of values. Throws
/// InputError.
std::vector<double> number_list(const std::string& text, const std::vector<std::size_t>& counts,
                                const std::string& what);

/// Parses the position of a part or program in workpiece coordinates, mm and deg: "X,Y,Z", "X,Y,Z,TURN"
/// (about z), or "X,Y,Z,rX,rY,rZ" (T Rx Ry Rz, as a sixdof transform of a machine file). An empty text is the
/// identity. Throws InputError.
Eigen::Isometry3d placement(const std::string& text, const std::string& what);

}  // namespace vernier::kinematics
