// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/encoding.h"
#include "tools/sheet/workbook.h"

namespace vernier::sheet {

/// Properties of a table that the user states. Other properties are detected.
struct SheetFormat {
  char separator = 0;                 // ',' ';' '\t'; ' ' means one or more blanks; 0: detected
  std::optional<bool> decimal_comma;  // detected if it has no value
  std::size_t skip = 0;               // number of lines at the top that do not belong to the table
  std::string comment = "#";          // lines that begin with this text are ignored; empty: no such lines
  std::optional<std::size_t> table;   // number (from 1) of one of several tables below each other
                                      // (keep_table)
  std::string sheet;                  // name or number of the sheet in a workbook; empty: the first sheet
                                      // with rows
};

/// A line of text that is no row of the table.
struct Remark {
  std::size_t line = 0;
  std::string text;
};

/// The cells of a table, and the settings with which it was read.
struct Sheet {
  std::string file;
  bool workbook = false;            // true: the file is a workbook (xlsx)
  std::string sheet;                // name of the sheet in the workbook
  std::vector<std::string> sheets;  // names of all sheets in the workbook
  Encoding encoding = Encoding::kUtf8;
  char separator = ',';
  bool decimal_comma = false;
  bool decimal_known = false;                  // true: a number shows the decimal sign, or the user stated it
  bool decimal_doubtful = false;               // true: every separator that was found can be a decimal sign
                                               // or a separator of thousands ("1,234")
  std::vector<std::vector<std::string>> rows;  // cells without leading and trailing blanks; all rows have the
                                               // same number of cells
  std::vector<std::size_t> line;               // line number of each row, from 1
  std::vector<std::size_t> written;            // number of cells of each row in the text; empty for a
                                               // workbook
  std::vector<Remark> remarks;                 // comments, and lines at the top that were skipped
  std::vector<FormattedCells> formats;         // of a workbook, see there
  std::vector<TextElsewhere> elsewhere;        // texts on the other visible sheets of a workbook
  std::vector<std::string> tables_beside;      // names of the other visible sheets with rows of numbers
  std::set<std::string> exact;                 // cells with a decimal sign that the workbook stores as
                                               // numbers: their sign separates no thousands
  std::vector<std::string> notes;              // notes for the user about rows that were left out
};

/// True if all cells of a row are empty.
bool is_blank(const std::vector<std::string>& row);

/// Removes one row and its line number. `row`: index of the row.
void remove_row(Sheet& sheet, std::size_t row);

/// True if a line begins with the text that a spreadsheet writes for a failed formula, in English or German.
/// A line with a failed formula is a row of the table and not a comment.
bool begins_with_error_value(const std::string& line);

/// True if the first bytes are those of a workbook (a zip file with a sheet).
bool is_workbook(std::string_view bytes);

/// Reads a table from a text or from a workbook. Throws InputError with file, line and word for: an unclosed
/// quote, a table without rows, a sheet that does not exist, a workbook of another kind (.xls), decimal signs
/// of both kinds.
Sheet read_sheet(const std::string& bytes, const std::string& file, const SheetFormat& format = {});

/// Returns the separator that gives the same number of fields in most lines of a text.
char guess_separator(const std::string& text, const std::string& comment);

/// Returns the name of a separator: "comma", "semicolon", "tab", "blanks".
const char* separator_word(char separator);

/// Returns the number in a cell; nullopt if the cell has no number with the decimal sign of the sheet.
std::optional<double> number_at(const Sheet& sheet, std::size_t row, std::size_t column);

}  // namespace vernier::sheet
