// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Returns the options that read a table in which nothing was recognised as measured, with its own headings.
/// The values decide between a measured position and a deviation; the text also names values that no option
/// reads rightly (the opposite sign, steps from row to row), and the correction in the file.
std::string assignments_to_try(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                               const std::vector<SheetColumn>& columns, const Guess& guess);

}  // namespace vernier::importer
