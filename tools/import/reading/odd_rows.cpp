// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/odd_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

bool names_state(const std::string& cell) {
  static constexpr std::array<std::string_view, 12> kStarts = {
      "temp", "luftdruck", "luftfeuchte", "lufttemp", "feuchte",   "humidity",
      "air",  "pressure",  "uhrzeit",     "pause",    "wartezeit", "werkstücktemp"};
  const std::vector<std::string> words = plain_words(cell);
  return !words.empty() && std::any_of(kStarts.begin(), kStarts.end(), [&](std::string_view start) {
    return words.front().starts_with(start);
  });
}

bool names_repetition(const std::string& cell) {
  static const std::set<std::string> kWords = {
      "nachmessung", "nachgemessen", "wiederholung", "wiederholt", "wiederholmessung", "remeasured",
      "repeat",      "repeated",     "repetition",   "again",      "nochmal",          "nochmals"};
  const std::vector<std::string> words = plain_words(cell);
  return std::any_of(words.begin(), words.end(), [](const auto& word) { return kWords.contains(word); });
}

}  // namespace

void leave_state_lines(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const auto position = table.has_headings ? column_of_positions(table) : std::nullopt;
  if (!position) return;
  std::vector<std::size_t> rows;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (names_state(sheet.rows[row][*position])) rows.push_back(row);
  if (2 * rows.size() >= sheet.rows.size() - table.first_data) return;
  for (const std::size_t row : rows)
    sheet.notes.push_back(
        fmt::format("line {}: \"{}\" is a line about the state between the rows of the table and is omitted",
                    sheet.line[row], text::trimmed(text::joined(sheet.rows[row], " "))));
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) sheet::remove_row(sheet, *row);
}

void note_repeated_readings(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const auto position = table.has_headings ? column_of_positions(table) : std::nullopt;
  if (!position) return;
  std::map<double, std::vector<std::size_t>> rows_at;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto at = sheet::number_at(sheet, row, *position)) rows_at[*at].push_back(row);
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, *position);
    const auto& cells = sheet.rows[row];
    const auto remark = std::find_if(cells.begin(), cells.end(), names_repetition);
    if (!at || remark == cells.end()) continue;
    const std::vector<std::size_t>& same = rows_at.at(*at);
    if (same.size() < 2) continue;
    sheet.notes.push_back(
        fmt::format("line {}: the remark \"{}\", and line {} has the same position {}: both rows are read; "
                    "if one of the two is "
                    "not valid, write \"invalid\" into its row",
                    sheet.line[row], *remark, sheet.line[same.front() == row ? same[1] : same.front()],
                    cells[*position]));
  }
}

void note_failed_formulas(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    for (const std::string& cell : sheet.rows[row])
      if (is_failed_formula(cell))
        sheet.notes.push_back(fmt::format("line {}: \"{}\" is a failed formula, and the cell has no value",
                                          sheet.line[row], cell));
}

}  // namespace vernier::importer
