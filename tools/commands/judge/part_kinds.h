// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/model/machine.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::commands::part_cli {

/// The options of a command that describe a part.
struct PartSource {
  std::string path, at, zero, place;
  double position_mm = 0, size_mm = 0, form_mm = 0;  // tolerances for all features of a part program
};

/// Returns the part at its position in the machine, from a list of features or from a part program. Throws
/// InputError if the input is not valid, and LimitNotMet if the machine cannot reach a point.
tolerance::PlacedPart placed_part(const PartSource& source, const model::Machine& machine);

/// Adds the command `vernier part conformity`.
void add_conformity(CLI::App& part);

}  // namespace vernier::commands::part_cli
