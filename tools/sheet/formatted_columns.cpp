// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/formatted_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/number_format.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::sheet {
namespace {

/// What a format shows beside the digits.
std::string shown_by(const NumberFormat& format) {
  std::string shown;
  const auto add = [&](const std::string& words) { shown += (shown.empty() ? "" : ", ") + words; };
  if (!format.text.empty()) add("\"" + format.text + "\"");
  if (format.percent) add("the number times 100");
  if (format.thousands) add("the number divided by 1000");
  if (format.other_sign) add("another sign");
  return shown;
}

void take_format(Sheet& sheet, const FormattedCells& cells) {
  const std::size_t k = cells.column;
  const auto begin = std::lower_bound(sheet.line.begin(), sheet.line.end(), cells.line);
  if (begin == sheet.line.end() || *begin != cells.line) return;  // a row that is not read
  const auto first = static_cast<std::size_t>(begin - sheet.line.begin());
  const auto is_number = [&](std::size_t row) {
    return plain_number(sheet.rows[row][k], sheet.decimal_comma).has_value();
  };
  std::size_t numbers = 0;  // of the column from the first of these cells on
  for (std::size_t row = first; row < sheet.rows.size(); ++row) numbers += is_number(row) ? 1 : 0;
  std::string* heading = nullptr;
  for (std::size_t row = first; row-- > 0 && heading == nullptr;)
    if (!sheet.rows[row][k].empty() && !is_number(row)) heading = &sheet.rows[row][k];
  if (heading == nullptr && cells.count < 2) return;  // a number beside its label
  const NumberFormat format = number_format(cells.code);
  const auto unit = unit_meant(format.text);
  const bool only_unit = unit && !format.percent && !format.thousands && !format.other_sign;
  if (heading != nullptr) {
    const Heading parsed = parse_heading(*heading);
    const std::string own = parsed.unit.empty() ? unit_meant(*heading).value_or("") : parsed.unit;
    if (only_unit && own == *unit) return;
    if (format.percent && heading->find('%') != std::string::npos) return;
    if (only_unit && own.empty() && parsed.unknown_unit.empty() && numbers == cells.count) {
      sheet.notes.push_back(
          fmt::format("the heading \"{}\" has no unit: [{}] is the unit of the number format {} of its cells",
                      *heading, *unit, cells.code));
      *heading += " [" + *unit + "]";
      return;
    }
  }
  sheet.notes.push_back(fmt::format(
      "the number format {} of {} cell{} from {} on shows {}: the numbers are read as they are stored ({}). "
      "If the cells mean what they show, change the numbers or the unit in the heading in the file",
      cells.code, cells.count, cells.count == 1 ? "" : "s", cells.first, shown_by(format),
      sheet.rows[first][k]));
}

}  // namespace

void take_number_formats(Sheet& sheet) {
  for (const FormattedCells& cells : sheet.formats) take_format(sheet, cells);
}

}  // namespace vernier::sheet
