// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/distances/named_points.h"
#include "tools/import/logs/nominal_list.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// Returns the points that the user stated. `words`: "A=30,30,0.2" (mm or deg, in the order of the axes; with
/// semicolons between the positions, a comma is a decimal comma). `constants`: words of the option --set;
/// an axis that a constant states has no position in the words. `machine`: the machine; null: the axes are X,
/// Y and Z. Throws InputError for: words of another form, another number of positions than axes, a name
/// twice.
NamedPoints stated_points(const std::vector<std::string>& words, const std::vector<std::string>& constants,
                          const model::Machine* machine);

/// Adds the points of a list of nominal positions: a spreadsheet with a column of names, and a heading with a
/// unit for each axis that no constant states. Points that the user stated already are not changed. Throws
/// InputError with file, line and word for: a missing axis or unit, a cell that is not a number, a name
/// twice, a list without names.
void add_listed_points(NamedPoints& points, const std::vector<std::string>& constants,
                       const NominalList& nominal, const model::Machine& machine);

}  // namespace vernier::importer
