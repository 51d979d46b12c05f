// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/encoding.h"

namespace vernier::sheet {

/// Settings of a table that are given and not guessed.
struct SheetFormat {
  char separator = 0;                 // ',' ';' '\t'; ' ' any run of blanks; 0: guessed
  std::optional<bool> decimal_comma;  // guessed if absent
  std::size_t skip = 0;               // lines at the top that are not part of the table
  std::string comment = "#";          // lines with this start are ignored; empty: no comments
  std::string sheet;                  // of a workbook, by name or number; empty: the first with rows
};

/// The cells of a table, and how it was read.
struct Sheet {
  std::string file;
  bool workbook = false;  // xlsx
  std::string sheet;      // its name in the workbook
  Encoding encoding = Encoding::kUtf8;
  char separator = ',';
  bool decimal_comma = false;
  bool decimal_doubtful = false;  // every decimal sign is ambiguous ("1,234")
  std::vector<std::vector<std::string>>
      rows;                       // cells without surrounding blanks; the same number in each row
  std::vector<std::size_t> line;  // 1-based, of each row
};

/// Is this a workbook (a zip with a sheet in it), by its first bytes?
bool is_workbook(std::string_view bytes);

/// Reads text or a workbook. Throws InputError with file, line and word: an open quote, no rows,
/// no such sheet, a workbook of another kind (.xls), decimal signs of both kinds. tool.
Sheet read_sheet(const std::string& bytes, const std::string& file, const SheetFormat& format = {});

/// Returns the separator that fits most lines of a text. tool.
char guess_separator(const std::string& text, const std::string& comment);

/// Returns "comma", "semicolon", "tab", "blanks".
const char* separator_word(char separator);

}  // namespace vernier::sheet
