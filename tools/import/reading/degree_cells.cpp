// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/degree_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr std::string_view kDegreeSign = "\u00b0";
constexpr double kSixty = 60;  // minutes in a degree, seconds in a minute

/// Removes the number at the begin of `rest`, and one of the signs behind it; nullopt if they are not there.
std::optional<double> take_part(std::string& rest, std::initializer_list<std::string_view> signs) {
  rest = text::trimmed(rest);
  std::size_t end = 0;
  while (end < rest.size() && std::string_view("0123456789.").find(rest[end]) != std::string_view::npos)
    ++end;
  const auto value = text::parse_number(rest.substr(0, end));
  if (end == 0 || !value) return std::nullopt;
  for (const std::string_view sign : signs)
    if (rest.compare(end, sign.size(), sign) == 0) {
      rest.erase(0, end + sign.size());
      return value;
    }
  return std::nullopt;
}

/// Degrees of 30°00'03", 30° 0', -1°30'00.5"; nullopt for other texts. Degrees alone are a number with unit.
std::optional<double> degrees_of(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  const bool negative = cell.starts_with('-') || cell.starts_with("\u2212");
  if (negative) cell.erase(0, cell.starts_with('-') ? 1 : std::string_view("\u2212").size());
  const auto degrees = take_part(cell, {kDegreeSign});
  if (!degrees) return std::nullopt;
  const auto minutes = take_part(cell, {"'", "\u2032", "\u2019"});
  if (!minutes || *minutes >= kSixty) return std::nullopt;
  double seconds = 0;
  if (!text::trimmed(cell).empty()) {
    const auto found = take_part(cell, {"\"", "\u2033", "''", "\u201d"});
    if (!found || *found >= kSixty || !text::trimmed(cell).empty()) return std::nullopt;
    seconds = *found;
  }
  const double value = *degrees + (*minutes + seconds / kSixty) / kSixty;
  return negative ? -value : value;
}

}  // namespace

std::set<std::size_t> convert_degree_cells(sheet::Sheet& sheet) {
  std::set<std::size_t> converted;
  for (auto& row : sheet.rows)
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k].find(kDegreeSign) == std::string::npos) continue;
      const auto value = degrees_of(row[k]);
      if (!value) continue;
      row[k] = text::fixed_text(*value, 9);  // 4 millionths of an arcsec
      if (sheet.decimal_comma) std::replace(row[k].begin(), row[k].end(), '.', ',');
      converted.insert(k);
    }
  if (!converted.empty())
    sheet.notes.push_back("cells with degrees, minutes and seconds are read as decimal degrees");
  return converted;
}

void state_degrees(sheet::SheetTable& table, const std::set<std::size_t>& converted) {
  for (const std::size_t k : converted)
    if (k < table.headings.size() && table.headings[k].unit.empty() && table.headings[k].unknown_unit.empty())
      table.headings[k].unit = "deg";
}

}  // namespace vernier::importer
