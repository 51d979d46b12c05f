// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::sheet {

/// A sheet of a workbook to be written. The first row of a sheet contains headings, which stay visible.
struct SheetToWrite {
  std::string name;
  std::vector<std::vector<std::string>> rows;  // a cell whose text is a number is written as a number
};

/// Returns the bytes of a workbook (.xlsx) with the given sheets. Equal sheets give equal bytes. Throws
/// std::runtime_error if the workbook cannot be written.
std::string workbook_of(const std::vector<SheetToWrite>& sheets);

}  // namespace vernier::sheet
