// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::kinematics {

/// Reads one state of the machine from a text: "X=100,Y=-20,dirX=1,T=25,feed=1000". The permitted names are
/// axes, inputs, v/a/dir/since of an axis, feed, curv, t, nx ny nz, and run (a label). The values are in base
/// units (mm, deg, mm/s ...). A quantity that the text does not contain is 0. An input that the text does not
/// contain has its reference value. If a word of the text is wrong, throws InputError with this word.
model::States state_at(const model::Machine& machine, const std::string& words);

/// Returns the machine with one of its named tools, or with a tool given as "X,Y,Z" (mm, from the end of the
/// chain). If the text is empty, the machine is not changed. Throws InputError if the text is neither the
/// name of a tool nor three numbers.
model::Machine tooled(const model::Machine& machine, const std::string& tool);

/// Reads numbers that are separated by commas. `counts`: the permitted numbers of values. Throws InputError
/// if the text is not a list of that many numbers.
std::vector<double> number_list(const std::string& text, const std::vector<std::size_t>& counts,
                                const std::string& what);

/// Reads the position of a part or program in workpiece coordinates, mm and deg. The forms are "X,Y,Z",
/// "X,Y,Z,TURN" (rotation about z), and "X,Y,Z,rX,rY,rZ" (T Rx Ry Rz, as a sixdof transform of a machine
/// file). An empty text means the identity. Throws InputError if the text has another form.
Eigen::Isometry3d placement(const std::string& text, const std::string& what);

}  // namespace vernier::kinematics
