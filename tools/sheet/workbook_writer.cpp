// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/workbook_writer.h"

#include <fmt/format.h>
#include <unistd.h>
#include <xlsxwriter.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::sheet {
namespace {

/// A temporary file for the library, which can only write to files.
class TemporaryFile {
 public:
  TemporaryFile() : path_((std::filesystem::temp_directory_path() / "vernier-XXXXXX").string()) {
    const int file = mkstemp(path_.data());
    if (file < 0) throw std::runtime_error("workbook: no temporary file in " + path_);
    close(file);
  }
  ~TemporaryFile() { unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

constexpr double kWidest = 60, kNarrowest = 9;  // of a column, in letters

void write_sheet(lxw_workbook* workbook, lxw_format* heading, const SheetToWrite& sheet) {
  lxw_worksheet* const out = workbook_add_worksheet(workbook, sheet.name.c_str());
  if (out == nullptr)
    throw std::runtime_error(fmt::format("workbook: no sheet of the name \"{}\"", sheet.name));
  std::vector<double> width;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (std::size_t k = 0; k < sheet.rows[row].size(); ++k) {
      const std::string& cell = sheet.rows[row][k];
      if (width.size() <= k) width.resize(k + 1, kNarrowest);
      width[k] = std::clamp(static_cast<double>(cell.size()) + 2, width[k], kWidest);
      const auto at = static_cast<lxw_row_t>(row);
      const auto column = static_cast<lxw_col_t>(k);
      if (const auto number = row == 0 ? std::nullopt : text::parse_number(cell))
        worksheet_write_number(out, at, column, *number, nullptr);
      else if (!cell.empty())
        worksheet_write_string(out, at, column, cell.c_str(), row == 0 ? heading : nullptr);
    }
  for (std::size_t k = 0; k < width.size(); ++k)
    worksheet_set_column(out, static_cast<lxw_col_t>(k), static_cast<lxw_col_t>(k), width[k], nullptr);
  worksheet_freeze_panes(out, 1, 0);
}

}  // namespace

std::string workbook_of(const std::vector<SheetToWrite>& sheets) {
  const TemporaryFile file;
  lxw_workbook* const workbook = workbook_new(file.path().c_str());
  if (workbook == nullptr) throw std::runtime_error("workbook: cannot be begun");
  // Without a fixed date a workbook contains its time of writing, and two files are never equal.
  lxw_doc_properties properties{};
  properties.created = 1;
  workbook_set_properties(workbook, &properties);
  lxw_format* const heading = workbook_add_format(workbook);
  format_set_bold(heading);
  for (const SheetToWrite& sheet : sheets) write_sheet(workbook, heading, sheet);
  const lxw_error failed = workbook_close(workbook);
  if (failed != LXW_NO_ERROR) throw std::runtime_error(std::string("workbook: ") + lxw_strerror(failed));
  return text::read_file(file.path());
}

}  // namespace vernier::sheet
