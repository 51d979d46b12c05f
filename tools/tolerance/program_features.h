// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::tolerance {

struct ProgramOptions {
  std::vector<double> zero;  // machine position of the program's origin, one value per axis
  /// Tolerances for all features that the program cuts.
  std::optional<double> position_mm, form_mm;
  std::optional<std::array<double, 2>> size_mm;
};

/// Returns the features that a part program cuts (RS-274, the dialect that tools/offline reads). A full
/// circle is a circle feature. All other moves between two rapid moves are a path; deviations along the path
/// are not evaluated. `at`, `known`: positions of the axes before the first block, and whether the position
/// of each axis is known. Throws InputError with file, line and word of the error.
PlacedPart program_part(const model::Machine& machine, const std::string& text, const std::string& file,
                        const model::States& at, const std::vector<char>& known,
                        const ProgramOptions& options);

}  // namespace vernier::tolerance
