// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::kinematics {

/// One state from a user's words: "X=100,Y=-20,dirX=1,T=25,feed=1000". Names: axes, inputs, v/a/dir/since of
/// an axis, feed, curv, t, nx ny nz, run (a label). Base units (mm, deg, mm/s ...). What is not named is 0;
/// inputs are at their reference. Throws InputError with the word. tool.
model::States state_at(const model::Machine& machine, const std::string& words);

/// The machine with one of its tools by name, or with a tool given as "X,Y,Z" (mm, beyond the end of the
/// chain); empty: as it is. Throws InputError. tool.
model::Machine tooled(const model::Machine& machine, const std::string& tool);

/// Numbers separated by commas; `counts` says how many there may be. Throws InputError. tool.
std::vector<double> number_list(const std::string& text, const std::vector<std::size_t>& counts,
                                const std::string& what);

}  // namespace vernier::kinematics
