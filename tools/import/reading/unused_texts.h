// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_columns.h"
#include "tools/import/words/table_texts.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Notes each text about a table that may change its numbers and that the import did not use: what the text
/// may change, and what to do. A text is used if a note of the sheet quotes it. A text about the sign or
/// about increments is not noted: a table of deviations is refused for such a text, and measured positions
/// do not depend on it. One more note quotes all texts that no note quotes. `table`: with the headings of the
/// file, before columns were joined.
void note_unused_texts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<TableText>& texts, const std::vector<SheetColumn>& columns);

/// What a row with words in place of numbers states, and what to do, for a refusal; empty: nothing special.
std::string advice_for_text(const std::string& text);

}  // namespace vernier::importer
