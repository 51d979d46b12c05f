// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/create/machine_plan.h"

namespace vernier::create {

/// Returns the text of a new machine file, with comments that explain each part. The new machine has
/// squareness with X as datum (names of ISO 230-1), location errors of rotary axes (ISO 230-7), and a table
/// of six errors for each axis. All errors of the new machine file are 0 (nominal). The file of a robot has
/// the rows of its joints, with Hayati's angle between parallel joints. parse_machine can read the text.
std::string machine_file(const MachinePlan& plan);

/// Returns the order of the axes as text, one line for each side: "bed > Y (beam) > X (carriage) > Z (ram) >
/// tool".
std::string drawing(const MachinePlan& plan);

}  // namespace vernier::create
