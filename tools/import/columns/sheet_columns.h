// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Returns the option that states the position of the axis of a deviation: --set "X[mm]=0".
std::string set_position(const SheetColumn& deviation);

/// Returns the meaning of each column by the assignments of the user and the headings alone, before values
/// decide. Throws InputError if an assignment of the user matches no column.
std::vector<SheetColumn> columns_by_headings(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const SheetWishes& wishes);

/// Returns the meaning of each column of a sheet. The meaning comes from the assignment of the user,
/// otherwise from the heading, and if the heading is ambiguous from the values. Throws InputError if an
/// assignment of the user matches no column.
std::vector<SheetColumn> columns_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const SheetWishes& wishes);

}  // namespace vernier::importer
