// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/model/machine.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::commands::part_cli {

/// The options of a command that name a part.
struct PartSource {
  std::string path, at, zero, place;
  double position_mm = 0, size_mm = 0, form_mm = 0;  // for all that a program cuts
};

/// Returns the part in its position in the machine, from a list of features or a part program. Throws
/// InputError, and LimitNotMet if a point is out of reach.
tolerance::PlacedPart placed_part(const PartSource& source, const model::Machine& machine);

/// Adds `vernier part conformity`.
void add_conformity(CLI::App& part);

}  // namespace vernier::commands::part_cli
