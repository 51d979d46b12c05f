// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/encoding.h"

namespace vernier::sheet {

/// Properties of a table that the user gives; other properties are detected.
struct SheetFormat {
  char separator = 0;                 // ',' ';' '\t'; ' ' any run of blanks; 0: guessed
  std::optional<bool> decimal_comma;  // guessed where absent
  std::size_t skip = 0;               // lines at the top that are no table
  std::string comment = "#";          // lines that begin with it are skipped; empty: no such lines
  std::optional<std::size_t> table;   // of several tables below each other, from 1 (keep_table)
  std::string sheet;                  // of a workbook, by name or number; empty: the first with rows
};

/// The cells of a table, and the settings with which the table was read.
struct Sheet {
  std::string file;
  bool workbook = false;            // xlsx
  std::string sheet;                // its name in the workbook
  std::vector<std::string> sheets;  // names of all of the workbook
  Encoding encoding = Encoding::kUtf8;
  char separator = ',';
  bool decimal_comma = false;
  bool decimal_known = false;                  // some number shows the sign, or the user gave it
  bool decimal_doubtful = false;               // every sign found could be either ("1,234")
  std::vector<std::vector<std::string>> rows;  // cells without blanks around them; as many in each
  std::vector<std::size_t> line;               // 1-based, of each row
  std::vector<std::size_t> written;            // cells of each row in the text; empty for a workbook
  std::vector<std::string> notes;              // what was left out, for the user
};

/// True if no cell of a row has a value.
bool is_blank(const std::vector<std::string>& row);

/// Removes one row with its line. row: index.
void remove_row(Sheet& sheet, std::size_t row);

/// True if a line begins with the text that a spreadsheet writes for a failed formula, in English or German.
/// It is a row.
bool begins_with_error_value(const std::string& line);

/// True if the first bytes are those of a workbook (a zip with a sheet).
bool is_workbook(std::string_view bytes);

/// Reads text or workbook. Throws InputError with file, line and word: an open quote, no rows, a sheet that
/// does not exist, a workbook of another kind (.xls), decimal signs of both kinds.
Sheet read_sheet(const std::string& bytes, const std::string& file, const SheetFormat& format = {});

/// The separator that most lines of a text agree on.
char guess_separator(const std::string& text, const std::string& comment);

/// "comma", "semicolon", "tab", "blanks".
const char* separator_word(char separator);

}  // namespace vernier::sheet
