// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// Columns of a sheet: the limit of SpreadsheetML (column XFD).
inline constexpr std::size_t kMostColumns = 16384;

/// A sheet of an Office Open XML workbook (ECMA-376 part 1, SpreadsheetML) as text: numbers with a decimal
/// point as stored, formulas by their last value, dates and times in the form of `date_text`.
struct WorkbookSheet {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // of different lengths; empty cells are empty
  std::vector<std::size_t> line;               // row number in the sheet
  std::vector<std::vector<char>> is_number;    // of each cell: stored as a number, not as text
  std::vector<std::string> all;                // names of all sheets of the workbook
  std::size_t hidden_rows = 0;                 // by a filter or by hand; they are among the rows
};

/// Reads the sheet with this name or number (from 1). Empty: the first visible sheet with two rows of two
/// numbers, not a cover sheet; in a workbook without such a sheet the first visible one that contains cells.
/// Cells that are merged over several rows of data each have the value. Throws InputError:
/// not a workbook, a sheet that does not exist (the error lists the sheets), a part of more than 256 MB.
WorkbookSheet read_workbook(const std::string& bytes, const std::string& file, const std::string& sheet);

}  // namespace vernier::sheet
