// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A workbook may have one sheet for each approach direction of an axis ("X vor", "X rück"). If the name of
/// the sheet that was read states a direction, and another sheet has the same name with the opposite one,
/// adds a column of directions, with a note. `both`: also adds the rows of the other sheet. The rows back are
/// in the opposite order of the rows forth, the order of the motion. "vor" and "hin" are the way that the
/// rows go; "X+" is used as written. Does nothing for other workbooks, and if the sheets have directions of
/// their own. Throws InputError if both sheets shall be read and do not have the same headings.
void join_paired_sheet(sheet::Sheet& sheet, sheet::SheetTable& table, const std::string& bytes,
                       const sheet::SheetFormat& format, bool both);

}  // namespace vernier::importer
