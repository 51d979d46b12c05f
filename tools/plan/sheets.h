// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/plan/plan.h"

namespace vernier::plan {

/// Returns the planned rows as a measurement file with empty readings: units in the header, run kPlanRun. The
/// file has only columns that the existing rows have or the two effects use.
std::string plan_csv(const Plan& plan);

/// Returns the planned rows as G-code. Each pose is approached in the required direction of motion; at rows
/// with a speed the machine passes along the velocity without a stop. Values that a person must set are in
/// comments. Millimetres, degrees, mm/min; axes have the names of the machine file. Approaches end within the
/// declared ranges.
std::string plan_gcode(const Plan& plan);

/// Returns poses that are reached one after another as G-code, like plan_gcode. `remark`: its first line.
std::string poses_gcode(const model::Machine& machine, const model::States& states,
                        const std::string& remark);

/// Returns the planned rows as a table for people.
std::string plan_table(const Plan& plan);

}  // namespace vernier::plan
