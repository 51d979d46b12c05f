// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// A sheet for output. Its first row contains the headings and stays visible.
struct SheetToWrite {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // a cell with the form of a number becomes a number
};

/// Returns the bytes of a workbook (.xlsx). The same sheets give the same bytes. Throws
/// std::runtime_error if it cannot be written. tool.
std::string workbook_of(const std::vector<SheetToWrite>& sheets);

}  // namespace vernier::sheet
