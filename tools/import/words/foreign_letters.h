// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Notes headings of a text in Windows-1252 that are probably in another encoding (Cyrillic, Japanese): three
/// letters beyond ASCII in a row, which no Western word has, or a byte that is no letter. A heading with
/// single letters of another encoding (Czech) is not recognised.
void note_foreign_letters(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
