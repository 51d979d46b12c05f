// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::tolerance {

struct ProgramOptions {
  std::vector<double> zero;  // machine position of the program's zero, by axis
  /// Tolerances for every feature that the program cuts.
  std::optional<double> position_mm, form_mm;
  std::optional<std::array<double, 2>> size_mm;
};

/// Returns the features that a part program cuts (RS-274, as tools/offline reads it). Whole circles are
/// circles; other moves between two rapid moves are a path, which is not evaluated along its direction. `at`,
/// `known`: positions of the axes before the first block. Throws InputError with file, line and word.
PlacedPart program_part(const model::Machine& machine, const std::string& text, const std::string& file,
                        const model::States& at, const std::vector<char>& known,
                        const ProgramOptions& options);

}  // namespace vernier::tolerance
