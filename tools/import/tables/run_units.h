// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Converts the numbers of columns of readings to the unit of the first of these columns, with a note. The
/// headings keep their texts and get this unit. `columns`: at least one index of a column. Returns false, and
/// changes nothing, if a column has no unit, or if the units have no common quantity (lengths or angles).
bool convert_to_one_unit(sheet::Sheet& sheet, sheet::SheetTable& table,
                         const std::vector<std::size_t>& columns);

}  // namespace vernier::importer
