// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// True for the heading of a remark: "Bemerkung", "Remarks".
bool names_remark(const sheet::Heading& heading);

/// Omits columns that are no measurement, with a note for each: verdicts about the readings ("OK?", "i.O.",
/// "n.i.O.", "Pass/Fail", "Bewertung") and remarks that are only numbers. A heading such as "Result" is a
/// verdict if its cells are verdicts too. Remarks in words stay as labels. The cells of an omitted column are
/// empty then. `named`: the columns that the user
/// names in an option or a profile, which stay. A row out of tolerance is a valid reading and stays.
void leave_verdicts(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named);

}  // namespace vernier::importer
