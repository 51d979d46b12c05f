// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// Largest number of columns in a sheet, by the limit of SpreadsheetML (column XFD).
inline constexpr std::size_t kMostColumns = 16384;

/// A text on another sheet of the workbook.
struct TextElsewhere {
  std::string sheet;
  bool table = false;  // true: the sheet has rows of numbers; false: a cover sheet
  std::string text;
};

/// Numbers of one column with one number format that shows more than the number: a unit, a percent sign,
/// another sign (NumberFormat).
struct FormattedCells {
  std::size_t column = 0;  // index
  std::string code;        // of the format
  std::string first;       // reference of the first cell: "D2"
  std::size_t line = 0;    // number of its row in the sheet
  std::size_t count = 0;
};

/// A sheet of an Office Open XML workbook (ECMA-376 part 1, SpreadsheetML) as text. Numbers have a decimal
/// point as they are stored; formulas have their last value; dates and times have the form of `date_text`.
struct WorkbookSheet {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // rows may have different lengths; an empty cell is an empty
                                               // text
  std::vector<std::size_t> line;               // number of each row in the sheet
  std::vector<std::vector<char>> is_number;    // for each cell: true if it is stored as a number, not as text
  std::vector<std::string> all;                // names of all sheets in the workbook
  std::size_t hidden_rows = 0;                 // number of rows that are hidden by a filter or by hand; they
                                               // are included in `rows`
  std::vector<TextElsewhere> elsewhere;        // texts on the other visible sheets
  std::vector<std::string> tables_beside;      // names of the other visible sheets with rows of numbers
  std::vector<std::string> unread;             // what no cell shows, in words: comments of cells, texts on
                                               // hidden sheets, a printed header, numbers struck out
  std::vector<FormattedCells> formats;         // columns whose number format shows more than the number
};

/// Reads the sheet with this name or number (from 1) from a workbook. If `sheet` is empty, the first visible
/// sheet with two rows of two numbers is read, which is not a cover page. If no visible sheet has two rows of
/// two numbers, the first visible sheet with cells is read. If cells are merged over several rows of data,
/// each of these rows has the value. Throws InputError if the data are not
/// a workbook, if the sheet does not exist (the message lists the sheets), or if a part has more than 256 MB.
WorkbookSheet read_workbook(const std::string& bytes, const std::string& file, const std::string& sheet);

}  // namespace vernier::sheet
