// SPDX-License-Identifier: GPL-3.0-or-later
// The texts of a file that are about a table, but are not in its headings.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A text outside the headings of a table.
struct TableText {
  std::size_t line = 0;  // 0: the text is on a cover sheet of the workbook
  std::string text;      // with the label ("Vorzeichen:") of the cell before it
  std::string sheet{};   // name of the cover sheet
  bool in_row = false;   // a cell with words beside the numbers of one row

  /// The text as a message quotes it: with the name of the cover sheet.
  std::string quoted() const { return sheet.empty() ? text : "sheet " + sheet + ": " + text; }
};

/// Returns the texts about a table: comments and lines above and below the table, cells with words in its
/// rows, and the texts of cover sheets of a workbook. Texts of other tables are not included.
std::vector<TableText> texts_about(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// As texts_about; the cells of one line above the headings are one text too, because a comma may separate
/// columns.
std::vector<TableText> sentences_about(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Moves a line with one text of several words, between the headings and the rows, above the headings as a
/// title: "Werte zurück in der Reihenfolge der Messung". The line is then no line of headings. The sheet gets
/// a note.
void take_sentences_below_headings(sheet::Sheet& sheet);

/// Notes that the table has no headings, because the line above its rows is one text.
void note_title_alone(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
