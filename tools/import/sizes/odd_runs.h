// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// The deviations of one run: position and approach direction (1, -1), deviation.
using RunDeviations = std::map<std::pair<double, int>, double>;

/// Returns the run whose deviations have the opposite sign of those of the other runs at all common places,
/// and one of these runs; nullopt: no such run. Of two runs, the second one. The sign of a run that only
/// scatters about zero agrees by chance with no other run: the residual of the comparison must be small.
std::optional<std::pair<std::string, std::string>> opposite_run(
    const std::map<std::string, RunDeviations>& runs);

/// Text about such a run, without the place: "all deviations of run 2 have the opposite sign …".
std::string opposite_run_text(const std::string& run, const std::string& other);

/// Notes runs that contradict the other runs of the table: all deviations with the opposite sign; one target
/// that no other run has, in place of a target that all other runs have (530 for 350); a run of zeros; a line
/// with the readings of several runs that repeats a line before it.
void note_odd_runs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                   const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
