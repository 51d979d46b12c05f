// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/create/machine_plan.h"

namespace vernier::create {

/// Returns the machine file of a plan, with comments that explain each part: squareness with X as datum (ISO
/// 230-1 names), location errors of rotary axes (ISO 230-7), a table of six errors per axis. All errors are
/// nominal 0. A robot has the rows of its joints, with Hayati's angle between parallel joints. parse_machine
/// reads the output.
std::string machine_file(const MachinePlan& plan);

/// Returns the order of the axes, one line per side: "bed > Y (beam) > X (carriage) > Z (ram) > tool".
std::string drawing(const MachinePlan& plan);

}  // namespace vernier::create
