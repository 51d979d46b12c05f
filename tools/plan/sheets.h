// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/plan/plan.h"

namespace vernier::plan {

/// Returns the planned rows as a measurement file without readings. Units are in the header, and the run is
/// kPlanRun. The file contains only columns that the existing rows have or that the two effects use.
std::string plan_csv(const Plan& plan);

/// Returns the planned rows as G-code. Each pose is approached in the required direction of motion. In rows
/// with a speed, the machine passes the pose along the velocity without a stop. Values that a person must set
/// are in comments of the G-code. Units are millimetres, degrees and mm/min. The axes have the names of the
/// machine file. The approach motions of the G-code stay within the declared ranges of the axes.
std::string plan_gcode(const Plan& plan);

/// Returns poses that are reached one after another as G-code, in the form of plan_gcode. `remark`: the first
/// line of the G-code.
std::string poses_gcode(const model::Machine& machine, const model::States& states,
                        const std::string& remark);

/// Returns the planned rows as a table for people.
std::string plan_table(const Plan& plan);

}  // namespace vernier::plan
