// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

/// Returns poses from which a plan may choose, distributed over the working ranges of the machine (Halton's
/// sequence, from its member `from` on). A third of the poses are at the ends of an axis, where errors are
/// largest. In these poses the inputs are at their reference. The poses contain both approach directions.
/// Throws InputError for an axis without a range.
model::States offered_poses(const model::Machine& machine, std::size_t count, std::size_t from);

/// Returns the chosen poses as a path: always to the nearest remaining pose, in shares of the
/// axes' ranges.
std::vector<std::size_t> nearest_way(const model::Machine& machine, const model::States& offered,
                                     const std::vector<std::size_t>& chosen);

/// Returns the headings of the inputs in a measurement file, and cells with their references: each with a
/// comma.
std::string input_headings(const model::Machine& machine);
std::string input_references(const model::Machine& machine);

/// Returns the rows of a measurement file with x, y, z to be filled in; check: the role of each; reading_um:
/// u of a coordinate.
std::string pose_rows_csv(const model::Machine& machine, const model::States& states,
                          const std::vector<char>& check, double reading_um, const std::string& run);

}  // namespace vernier::plan
