// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/degree_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Degrees of three numbers separated by blanks: "30 00 05", "-1 30 00,5"; nullopt for other texts.
std::optional<double> degrees_of_numbers(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  const bool negative = cell.starts_with('-');
  if (negative) cell.erase(0, 1);
  const std::vector<std::string> parts = text::words_in(cell, " ");
  constexpr std::size_t kParts = 3;  // degrees, minutes, seconds
  if (parts.size() != kParts) return std::nullopt;
  double value = 0, size = 1;
  for (const std::string& part : parts) {
    const auto number = text::parse_number(part);
    if (!number || part.find_first_not_of("0123456789.") != std::string::npos) return std::nullopt;
    if (size < 1 && *number >= kSixty) return std::nullopt;
    value += *number * size;
    size /= kSixty;
  }
  return negative ? -value : value;
}

/// True for the heading of a column of degrees, minutes and seconds: "C [° ' \"]", "C [DMS]".
bool names_three_parts(const std::string& cell) {
  const auto open = cell.find('['), close = cell.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return false;
  const std::string unit = text::in_small_letters(cell.substr(open + 1, close - open - 1));
  const auto has = [&](std::string_view sign) { return unit.find(sign) != std::string::npos; };
  return unit == "dms" || unit == "gms" || unit == "deg min sec" || unit == "grad min sek" ||
         (has(kDegreeSign) && (has("'") || has("\u2032")) && (has("\"") || has("''") || has("\u2033")));
}

/// Converts the cells of columns whose heading says that they have three numbers, and writes [deg] into it.
bool convert_three_numbers(sheet::Sheet& sheet) {
  bool any = false;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (std::size_t k = 0; k < sheet.rows[row].size(); ++k) {
      std::string& heading = sheet.rows[row][k];
      if (!names_three_parts(heading)) continue;
      bool found = false;
      for (std::size_t below = row + 1; below < sheet.rows.size(); ++below) {
        std::string& cell = sheet.rows[below][k];
        const auto value = degrees_of_numbers(cell);
        if (!value) continue;
        cell = text::fixed_text(*value, 9);  // 4 millionths of an arcsec
        if (sheet.decimal_comma) std::replace(cell.begin(), cell.end(), '.', ',');
        found = true;
      }
      if (found) heading.replace(heading.find('['), std::string::npos, "[deg]");
      any |= found;
    }
  return any;
}

}  // namespace

std::set<std::size_t> convert_degree_cells(sheet::Sheet& sheet) {
  std::set<std::size_t> converted;
  const bool three = convert_three_numbers(sheet);
  for (auto& row : sheet.rows)
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k].find(kDegreeSign) == std::string::npos) continue;
      const auto value = degrees_of(row[k]);
      if (!value) continue;
      row[k] = text::fixed_text(*value, 9);  // 4 millionths of an arcsec
      if (sheet.decimal_comma) std::replace(row[k].begin(), row[k].end(), '.', ',');
      converted.insert(k);
    }
  if (three || !converted.empty())
    sheet.notes.push_back("cells with degrees, minutes and seconds are read as decimal degrees");
  return converted;
}

void state_degrees(sheet::SheetTable& table, const std::set<std::size_t>& converted) {
  for (const std::size_t k : converted)
    if (k < table.headings.size() && table.headings[k].unit.empty() && table.headings[k].unknown_unit.empty())
      table.headings[k].unit = "deg";
}

}  // namespace vernier::importer
