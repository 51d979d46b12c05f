// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/create/machine_plan.h"

namespace vernier::create {

/// The machine file of a plan, with remarks that say what each part is for: squareness with X as datum (ISO
/// 230-1 names), location errors of turning axes (ISO 230-7), a table of six errors an axis, all nominal 0; a
/// robot by its rows, with Hayati's angle between parallel joints. What it writes parse_machine reads. tool.
std::string machine_file(const MachinePlan& plan);

/// The order of the axes, one line per side: "bed > Y (beam) > X (carriage) > Z (ram) > tool". tool.
std::string drawing(const MachinePlan& plan);

}  // namespace vernier::create
