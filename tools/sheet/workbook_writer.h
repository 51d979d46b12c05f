// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// A sheet to be written: its first row contains headings that stay visible.
struct SheetToWrite {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // a cell that reads as a number becomes one
};

/// Returns the bytes of a workbook (.xlsx). The same sheets give the same bytes. Throws std::runtime_error if
/// the workbook cannot be written.
std::string workbook_of(const std::vector<SheetToWrite>& sheets);

}  // namespace vernier::sheet
