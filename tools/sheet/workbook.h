// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// A sheet of an Office Open XML workbook (ECMA-376 part 1, SpreadsheetML) as text. Numbers have a
/// decimal point as stored. Formulas have their last value. Cells that are shown as a date or a
/// time are converted by `date_text`.
struct WorkbookSheet {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // of different lengths; empty cells are empty
  std::vector<std::size_t> line;               // row number in the sheet
};

/// Reads the sheet with that name or number from 1 (empty: the first that contains cells). Throws
/// InputError: no workbook, no such sheet (the message names the others), a part of more than 256
/// MB. tool.
WorkbookSheet read_workbook(const std::string& bytes, const std::string& file, const std::string& sheet);

}  // namespace vernier::sheet
