// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/sheet_columns.h"

namespace vernier::importer {

/// Notes the words in the headings of the columns that are read, if no rule reads these words:
/// "Abweichung X [µm] zehnfach". `written`: with the headings of the file; `table`, `columns`: as they are
/// read; `found`: headings that the program assigned itself.
void note_heading_words(sheet::Sheet& sheet, const sheet::SheetTable& written, const sheet::SheetTable& table,
                        const std::vector<SheetColumn>& columns, const SheetWishes& wishes,
                        const std::vector<std::string>& found);

/// Notes the columns beside the readings whose words or numbers may say which rows count, or what the
/// readings are: "Status", "Faktor", "Bemerkung".
void note_columns_beside(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

}  // namespace vernier::importer
