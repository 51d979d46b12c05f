// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

/// Returns poses that a plan may select, distributed over the working ranges of the machine (Halton sequence,
/// beginning with element `from`). In a third of the poses, an axis is at an end of its range, where errors
/// are largest. In these poses the inputs have their reference values. The poses contain both approach
/// directions of the axes. Throws InputError if an axis has no range.
model::States offered_poses(const model::Machine& machine, std::size_t count, std::size_t from);

/// Returns the selected poses in the order of a path. The next pose is always the nearest remaining pose,
/// with distances as shares of the ranges of the axes.
std::vector<std::size_t> nearest_way(const model::Machine& machine, const model::States& offered,
                                     const std::vector<std::size_t>& chosen);

/// Returns the headings of the inputs in a measurement file (input_headings), or cells with their reference
/// values (input_references). Each heading or cell has a comma.
std::string input_headings(const model::Machine& machine);
std::string input_references(const model::Machine& machine);

/// Returns the rows of a measurement file in which the user enters x, y, z. `check`: true for check rows;
/// `reading_um`: standard uncertainty u of a coordinate.
std::string pose_rows_csv(const model::Machine& machine, const model::States& states,
                          const std::vector<char>& check, double reading_um, const std::string& run);

}  // namespace vernier::plan
