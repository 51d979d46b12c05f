// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

/// Returns the direction of the motion to each position (1, -1; 0: no motion) in its run. The first position
/// of a run has the direction of the next motion. A position that is the one before again begins the next
/// motion: a run back that begins where the run out ended; at the end of a run, it has the direction of the
/// last motion. `runs`: the run of each position; empty: all positions are one run.
std::vector<int> directions_by_motion(const std::vector<double>& positions,
                                      const std::vector<std::string>& runs);

/// Returns the direction of the last motion (1, -1) before each reading; 0: before the first motion of its
/// run. A change of at most `still` is no motion: an axis at rest is displayed with its last digits changing.
std::vector<int> directions_of_last_motion(const std::vector<double>& positions,
                                           const std::vector<std::string>& runs, double still);

/// Adds the approach direction (dirX) of each axis of the table that has none, by the order of the rows
/// (directions_of_last_motion). Rows of one run and set-up are a sequence of motions. Returns the names of
/// the columns that were added. Throws InputError if no axis of the table moves.
std::vector<std::string> add_directions_from_order(ImportTable& table,
                                                   const std::function<bool(const std::string&)>& is_axis);

}  // namespace vernier::importer
