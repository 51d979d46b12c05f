// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/columns_beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/unread_words.h"
#include "tools/sheet/dates.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

bool is_quoted(const sheet::Sheet& sheet, const std::string& text) {
  return std::any_of(sheet.notes.begin(), sheet.notes.end(), [&](const std::string& note) {
    return note.find("\"" + text + "\"") != std::string::npos ||
           note.find("\"" + text + ": ") != std::string::npos;  // the row with "Messung gültig: 0"
  });
}

bool is_by_user(const SheetColumn& column) {
  return column.why == "as given" || column.why == "by the profile";
}

/// True for a column whose meaning the format knows: an axis, a reading, a direction, a run.
bool is_meant(const SheetColumn& column, const Guess& guess) {
  if (column.use == SheetColumn::Use::kLeft) return false;
  return column.use == SheetColumn::Use::kDeviation || guess.is_axis(column.name) ||
         guess.is_motion(column.name) || is_known_name(column.name) || is_sense(column.name);
}

bool is_reading(const SheetColumn& column) {
  const format::ColumnGroup* const group =
      column.use == SheetColumn::Use::kColumn ? format::find_column(column.name) : nullptr;
  return column.use == SheetColumn::Use::kDeviation ||
         (group != nullptr && group->use == format::ColumnUse::kReading);
}

std::optional<format::Dimension> dimension_of(const SheetColumn& column) {
  const auto unit = column.unit.empty() ? std::nullopt : format::find_unit(column.unit);
  return unit ? std::optional(unit->dimension) : std::nullopt;
}

/// True for a heading that one rule reads as a whole: "X", "dirX", "Rolle", "U(k=2)".
bool is_read_whole(const sheet::Heading& heading, const SheetColumn& column, const Guess& guess) {
  if (heading.name == column.name) return true;
  return column.use == SheetColumn::Use::kColumn && !guess.is_axis(column.name) && !is_reading(column);
}

/// True for one word without a sign before it: a rule reads it, or the column is not read.
bool is_one_word(const sheet::Heading& heading) {
  return heading_words(heading.text).size() == 1 && !heading.text.starts_with('-') &&
         !heading.text.starts_with('+');
}

/// The different cells of a column in their order, each with the number of its rows.
std::vector<std::pair<std::string, std::size_t>> values_of(const sheet::Sheet& sheet,
                                                           const sheet::SheetTable& table, std::size_t k) {
  std::vector<std::pair<std::string, std::size_t>> values;
  std::map<std::string, std::size_t> place;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (k >= sheet.rows[row].size() || is_missing(sheet.rows[row][k])) continue;
    const auto [at, is_new] = place.emplace(sheet.rows[row][k], values.size());
    if (is_new) values.emplace_back(sheet.rows[row][k], 0);
    ++values[at->second].second;
  }
  return values;
}

}  // namespace

void note_heading_words(sheet::Sheet& sheet, const sheet::SheetTable& written, const sheet::SheetTable& table,
                        const std::vector<SheetColumn>& columns, const SheetWishes& wishes,
                        const std::vector<std::string>& found) {
  if (!written.has_headings) return;
  const Guess guess(wishes);
  bool directed = false;
  for (const sheet::Heading& heading : written.headings) directed |= is_sense(guess.column(heading).name);
  std::set<std::vector<std::string>> noted;
  for (const sheet::Heading& heading : written.headings) {
    std::size_t k = 0;  // the column as it is read; runs side by side have none
    while (k < table.headings.size() && (table.headings[k].joined || table.headings[k].text != heading.text))
      ++k;
    const bool alone = k < columns.size();
    if (is_one_word(heading) || (alone && is_read_whole(heading, columns[k], guess))) continue;
    if (alone &&
        (!is_meant(columns[k], guess) ||
         (is_by_user(columns[k]) && std::find(found.begin(), found.end(), heading.text) == found.end())))
      continue;
    if (guess.is_axis(heading.name) || (!alone && is_quoted(sheet, heading.text))) continue;
    const std::vector<std::string> all = heading_words(text::in_small_letters(heading.text));
    const bool run = !alone || std::any_of(all.begin(), all.end(), says_run);
    std::vector<std::string> words = unread_words(heading.name, {run, directed});
    const bool part = heading.unit.starts_with("0.");  // "1/100": the number is in the unit
    std::erase_if(words, [&](const std::string& word) {
      return guess.is_axis(word) || (part && heading.text.find("/" + word) != std::string::npos);
    });
    if (words.empty() || !noted.insert(words).second) continue;
    sheet.notes.push_back(
        fmt::format("of the heading \"{}\" the import does not use \"{}\": if this changes the values, their "
                    "sign (--sign) "
                    "or unit, or the positions, change the file accordingly",
                    heading.text, text::joined(words, " ")));
  }
}

void note_columns_beside(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  constexpr std::size_t kShown = 3;  // values of one column
  const Guess guess(wishes);
  std::set<std::optional<format::Dimension>> read = {std::nullopt};
  for (const SheetColumn& column : columns)
    if (is_reading(column)) read.insert(dimension_of(column));
  const bool readings = std::any_of(columns.begin(), columns.end(), is_reading);
  if (!table.has_headings || !readings) return;  // without a reading the table is refused
  std::string list;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    const std::string& heading = table.headings[k].text;
    const bool left = column.use == SheetColumn::Use::kLeft;
    if ((left && column.why != "no numbers") || is_by_user(column) || is_meant(column, guess) ||
        !read.contains(dimension_of(column)) || heads_counting(heading) || counts_rows(sheet, table, k) ||
        is_quoted(sheet, heading))
      continue;
    const auto values = values_of(sheet, table, k);
    std::string shown;
    std::size_t count = 0;
    bool dates = !values.empty();
    for (const auto& [value, rows] : values) {
      dates &= sheet::is_date(value);
      if (is_quoted(sheet, value) || ++count > kShown) continue;
      shown +=
          fmt::format("{}\"{}\" in {} row{}", shown.empty() ? "" : ", ", value, rows, rows == 1 ? "" : "s");
    }
    if (count == 0 || dates) continue;
    if (count > kShown) shown += fmt::format(" and {} other values", count - kShown);
    list += fmt::format("{}column \"{}\" ({})", list.empty() ? "" : ", ", heading, shown);
  }
  if (list.empty()) return;
  sheet.notes.push_back(fmt::format(
      "beside the readings: {}. No reading is changed or left out by these columns: delete rows that do not "
      "count; if a column states a factor, an offset, a sign or a unit, change the values in the file",
      list));
}

}  // namespace vernier::importer
