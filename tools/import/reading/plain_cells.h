// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Replaces cells with a value and its uncertainty ("3,2 ± 0,4") by the value, with a note: the sheet does
/// not state whether the second number is a standard uncertainty.
void leave_tolerances(sheet::Sheet& sheet);

/// Omits columns of results beside the table, with a note: the heading ends with "=" ("A=", "B ="), and few
/// rows have a value. The cells of an omitted column are empty then. `named`: options of the user; a column
/// that an option names stays.
void leave_results(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named);

/// Makes a column of roles in other words ("Verwendung" with Prüfung and Anpassung) the column role with
/// check and fit, with a note. `named`: as above.
void settle_roles(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named);

/// Makes a column of expanded uncertainties with their coverage factor ("U(k=2) [µm]") the standard
/// uncertainty u: each value divided by k, with a note. Omits uncertainties of single coordinates (Ux, Uy,
/// Uz), with a note. `named`: as above.
void settle_uncertainties(sheet::Sheet& sheet, sheet::SheetTable& table,
                          const std::vector<std::string>& named);

/// Notes a title that states that the runs back are in the order of time, if the table has runs side by side:
/// the runs are read at the positions in their rows.
void note_order_of_time(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
