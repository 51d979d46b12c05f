// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/points_alone.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/format/columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {

std::string points_alone(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns) {
  if (sheet.workbook) return "";
  std::set<std::string> coordinates;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kLeft || column.words || heads_counting(table.headings[k].text))
      continue;
    const std::string name = text::in_small_letters(column.name);
    const bool point = column.use == SheetColumn::Use::kColumn &&
                       std::any_of(std::begin(format::columns::kPoint), std::end(format::columns::kPoint),
                                   [&](const char* coordinate) { return name == coordinate; });
    if (!point || !coordinates.insert(name).second) return "";
  }
  if (coordinates.size() < std::size(format::columns::kPoint)) return "";
  return fmt::format(
      "the table has X, Y and Z alone. If they are points that an instrument measured, such as a laser "
      "tracker, and another file LIST has the positions of the axes, give: vernier import tracker {0} "
      "--machine MACHINE --nominal LIST -o OUTPUT.csv. If they are positions of the axes, the points are in "
      "another file, and {0} is the LIST of this command",
      sheet.file);
}

}  // namespace vernier::importer
