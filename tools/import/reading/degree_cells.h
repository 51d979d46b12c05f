// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <set>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Converts cells with degrees, minutes and seconds (30°00'03") to decimal degrees, with a note. Returns the
/// columns that were converted.
std::set<std::size_t> convert_degree_cells(sheet::Sheet& sheet);

/// States the unit deg in the headings of converted columns that have no unit.
void state_degrees(sheet::SheetTable& table, const std::set<std::size_t>& converted);

}  // namespace vernier::importer
