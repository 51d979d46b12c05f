// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/rows_below.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

bool names_difference(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
  return words.size() == 1 &&
         (words[0] == "difference" || words[0] == "differenz" || words[0] == "diff" || words[0] == "delta");
}

bool one_dimension(const std::string& one, const std::string& other) {
  if (one == other) return true;
  const auto a = format::find_unit(one), b = format::find_unit(other);
  return !one.empty() && !other.empty() && a && b && a->dimension == b->dimension;
}

/// Step of the last decimal of a column of numbers.
double last_digit_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  std::size_t decimals = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    decimals = std::max(decimals, sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma));
  return std::pow(10, -static_cast<double>(decimals));
}

/// True if a column has the differences between two others, to the last digit, in each row. Columns without
/// a difference are no sign of a computed column.
bool is_difference_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t difference,
                      std::size_t a, std::size_t b) {
  constexpr double kRoundings = 1.51;  // half a digit for each of three cells
  constexpr std::size_t kFewest = 3;   // fewer rows agree by chance
  const auto factor = [&](std::size_t k) {
    const std::string& unit = table.headings[k].unit;
    const auto known = unit.empty() ? std::nullopt : format::find_unit(unit);
    return known ? known->factor : 1.0;
  };
  const double own = factor(difference), of_readings = factor(a) / own;
  const double digit = kRoundings * std::max(last_digit_of(sheet, table, difference),
                                             of_readings * last_digit_of(sheet, table, a));
  std::size_t rows = 0;
  bool any = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, difference), one = sheet::number_at(sheet, row, a),
               other = sheet::number_at(sheet, row, b);
    if (!value || !one || !other) continue;
    if (std::abs(of_readings * std::abs(*one - *other) - std::abs(*value)) > digit) return false;
    any |= std::abs(*value) > digit;
    ++rows;
  }
  return any && rows >= kFewest;
}

}  // namespace

void refuse_counts_below(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  constexpr std::size_t kFewestRows = 4;  // fewer rows show no order
  const std::size_t rows = sheet.rows.size();
  const auto position = table.has_headings ? column_of_positions(table) : std::nullopt;
  if (!position || rows < table.first_data + kFewestRows + 1) return;
  std::size_t gaps = 0;
  for (std::size_t row = table.first_data + 1; row < rows; ++row)
    gaps += sheet.line[row] > sheet.line[row - 1] + 1 ? 1 : 0;
  const std::size_t last = rows - 1;
  if (gaps != 1 || sheet.line[last] <= sheet.line[last - 1] + 1) return;
  const auto at = sheet::number_at(sheet, last, *position),
             before = sheet::number_at(sheet, last - 1, *position),
             earlier = sheet::number_at(sheet, last - 2, *position);
  if (!at || !before || !earlier) return;
  // The next position of the survey, or one that it visited before.
  if ((*at - *before) * (*before - *earlier) > 0) return;
  for (std::size_t row = table.first_data; row < last; ++row)
    if (const auto other = sheet::number_at(sheet, row, *position); other && *other == *at) return;
  throw text::InputError(
      {sheet.file, sheet.line[last]}, sheet.rows[last][*position],
      fmt::format("this row is behind an empty line, and \"{}\" is not in the order of the rows above it: if "
                  "the row is no measurement (a count, a range), delete the row; if it is a measurement, "
                  "delete the empty lines above it",
                  table.headings[*position].text));
}

void leave_differences(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named) {
  if (!table.has_headings) return;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const bool by_option = std::any_of(named.begin(), named.end(), [&](const std::string& option) {
      return option.find(table.headings[k].name) != std::string::npos;
    });
    if (by_option || !names_difference(table.headings[k])) continue;
    for (std::size_t a = 0; a < table.headings.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const bool readings = a != k && b != k && table.headings[a].unit == table.headings[b].unit &&
                              one_dimension(table.headings[a].unit, table.headings[k].unit);
        if (!readings || !is_difference_of(sheet, table, k, a, b)) continue;
        sheet.notes.push_back(
            fmt::format("the column \"{}\" is the difference between \"{}\" and \"{}\" and is omitted",
                        table.headings[k].text, table.headings[b].text, table.headings[a].text));
        table.headings.erase(table.headings.begin() + static_cast<std::ptrdiff_t>(k));
        for (auto& row : sheet.rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(k));
        sheet.written.clear();
        return;
      }
  }
}

}  // namespace vernier::importer
