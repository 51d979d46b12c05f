// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

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

}  // namespace vernier::importer
