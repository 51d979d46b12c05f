// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/side_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>

#include "tools/import/columns/column_guess.h"
#include "tools/import/tables/computed_rows.h"
#include "tools/import/tables/statistic_values.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

bool is_empty(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  if (!table.headings[k].text.empty() &&
      table.headings[k].name.find_first_not_of("0123456789") != std::string::npos)
    return false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet.rows[row][k].empty()) return false;
  return true;
}

/// Different words of statistics in rows that have a position and are no statistics themselves.
std::size_t words_beside_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k,
                              const std::vector<std::size_t>& positions) {
  std::set<std::string> words;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (says_computed_row(sheet.rows[row][k]) && has_number(sheet, row, positions))
      words.insert(text::in_small_letters(sheet.rows[row][k]));
  return words.size();
}

bool has_readings(const sheet::SheetTable& table, std::size_t begin, std::size_t end) {
  const SheetWishes usual;
  const Guess guess(usual);
  for (std::size_t k = begin; k < end; ++k)
    if (guess.column(table.headings[k]).use == SheetColumn::Use::kDeviation ||
        Guess::bare(table.headings[k].name) == Guess::Bare::kActual ||
        is_known_name(guess.column(table.headings[k]).name))
      return true;
  return false;
}

}  // namespace

void leave_side_statistics(sheet::Sheet& sheet, sheet::SheetTable& table,
                           const std::vector<std::string>& named) {
  const std::vector<std::size_t> positions = position_columns(table);
  if (positions.empty()) return;
  const std::size_t width = table.headings.size();
  for (std::size_t k = positions.front() + 1; k < width; ++k) {
    if (words_beside_rows(sheet, table, k, positions) < 2) continue;
    std::size_t begin = k, end = k;
    while (begin > positions.front() && !is_empty(sheet, table, begin - 1)) --begin;
    const bool apart = begin > positions.front();
    if (!apart) begin = k;
    while (end < width && !is_empty(sheet, table, end)) ++end;
    const bool has_position = std::any_of(positions.begin(), positions.end(),
                                          [&](std::size_t one) { return one >= begin && one < end; });
    const bool by_option = std::any_of(named.begin(), named.end(), [&](const std::string& option) {
      return std::any_of(
          table.headings.begin() + static_cast<std::ptrdiff_t>(begin),
          table.headings.begin() + static_cast<std::ptrdiff_t>(end),
          [&](const sheet::Heading& one) { return option.find(one.name) != std::string::npos; });
    });
    if (has_position || by_option || (!apart && has_readings(table, begin, end))) continue;
    std::string names;
    for (std::size_t one = begin; one < end; ++one) {
      names += (names.empty() ? "\"" : ", \"") + table.headings[one].text + "\"";
      for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) sheet.rows[row][one].clear();
    }
    sheet.notes.push_back(
        fmt::format("the columns {} have statistics beside the rows of the table and are omitted", names));
    k = end;
  }
}

}  // namespace vernier::importer
