// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/stated_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/stated_directions.h"
#include "tools/import/words/table_texts.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Kind = StatedDirections::Kind;

struct Found {
  StatedDirections stated;
  TableText text;
  bool any = false;  // false: no text was found
};

/// How a note names a text.
std::string named(const TableText& text) {
  const std::string at = text.line > 0 ? fmt::format(" (line {})", text.line) : "";
  return fmt::format("the text \"{}\"{}", text.quoted(), at);
}

/// The first text that states directions; a text that states them clearly before the others.
Found stated_in(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  Found found;
  for (const TableText& one : sentences_about(sheet, table)) {
    StatedDirections stated = directions_stated(one.text);
    if (stated.kind == Kind::kNothing ||
        (found.any && (found.stated.kind != Kind::kUnclear || stated.kind == Kind::kUnclear)))
      continue;
    found.stated = std::move(stated);
    found.text = one;
    found.any = true;
  }
  return found;
}

/// Does the user state the directions of the rows?
bool stated_by_user(const SheetWishes& wishes) {
  const auto senses = [](const auto& one) { return is_sense(one.name); };
  return wishes.directions_from_order ||
         std::any_of(wishes.constants.begin(), wishes.constants.end(), senses) ||
         std::any_of(wishes.assignments.begin(), wishes.assignments.end(),
                     [&](const auto& one) { return senses(one.column); });
}

/// What a note adds if the text states the changes of the direction only.
std::string assumption(const Found& found) {
  return found.stated.assumed
             ? " (the text names the other direction only: the other runs are taken as forward)"
             : "";
}

int number_of(const std::string& run) {
  const auto number = text::parse_count(run);
  return number ? static_cast<int>(*number) : 0;
}

void note_unclear(sheet::Sheet& sheet, const Found& found) {
  sheet.notes.push_back(
      found.stated.one_way
          ? fmt::format("{} states that all runs have one approach direction, but not which one: give --set "
                        "dirX=1, or --set dirX=-1 (with the name of the axis)",
                        named(found.text))
          : fmt::format(
                "{} is about the approach directions of the runs, and does not state that of each run: no "
                "direction is read; write + or - behind the number of each run",
                named(found.text)));
}

}  // namespace

void take_stated_directions(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes,
                            std::vector<RunColumn>& runs) {
  const bool directed =
      std::any_of(runs.begin(), runs.end(), [](const RunColumn& one) { return one.sense != 0; });
  if (directed || stated_by_user(wishes)) return;
  const Found found = stated_in(sheet, table);
  if (!found.any) return;
  const bool each = std::all_of(runs.begin(), runs.end(), [&](const RunColumn& one) {
    return found.stated.of(number_of(one.run), static_cast<int>(runs.size())) != 0;
  });
  if (!each) return note_unclear(sheet, found);
  std::vector<std::string> names;
  for (RunColumn& one : runs) {
    one.sense = found.stated.of(number_of(one.run), static_cast<int>(runs.size()));
    one.relative = one.forth = found.stated.way;
    names.push_back(one.run + (one.sense > 0 ? "+" : "-"));
  }
  sheet.notes.push_back(fmt::format(
      "{} states the approach directions of the runs: {}{}; if this is wrong, write + or - behind the "
      "number of each run in its heading",
      named(found.text), text::joined(names, ", "), assumption(found)));
}

void turn_runs_back(sheet::Sheet& sheet, const sheet::SheetTable& table, const std::vector<RunColumn>& runs,
                    std::size_t position) {
  std::vector<std::size_t> columns;
  std::string names;
  bool forth = false;
  for (const RunColumn& one : runs) {
    forth |= one.sense > 0;
    if (one.sense >= 0) continue;
    columns.push_back(one.column);
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", table.headings[one.column].text);
  }
  if (columns.empty() || !forth) return;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::pair<double, double> span(kNone, -kNone);
  std::vector<std::size_t> rows;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto at = sheet::number_at(sheet, row, position)) {
      span = {std::min(span.first, *at), std::max(span.second, *at)};
      rows.push_back(row);
    }
  for (const TableText& one : sentences_about(sheet, table)) {
    const BackOrder order = back_order_stated(one.text, span);
    if (order == BackOrder::kNothing) continue;
    if (order == BackOrder::kUnclear) {
      sheet.notes.push_back(
          fmt::format("{} may state the order of the readings of the way back ({}): each is read at the "
                      "position of its row; "
                      "if they are in the order of their measurement, reverse the order of the values of "
                      "this column in the "
                      "file",
                      named(one), names));
      return;
    }
    for (const std::size_t k : columns)
      for (std::size_t i = 0; 2 * i + 1 < rows.size(); ++i)
        std::swap(sheet.rows[rows[i]][k], sheet.rows[rows[rows.size() - 1 - i]][k]);
    sheet.notes.push_back(
        fmt::format("{} states that the readings of the way back ({}) are in the order of their measurement: "
                    "the last row is "
                    "read as the first position of the table; if each reading is at the position of its row, "
                    "delete this text",
                    named(one), names));
    return;
  }
}

void add_stated_directions(sheet::Sheet& sheet, sheet::SheetTable& table, const SheetWishes& wishes) {
  if (!table.has_headings || stated_by_user(wishes)) return;
  const Guess guess(wishes);
  std::optional<std::size_t> runs;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const std::string name = guess.column(table.headings[k]).name;
    if (is_sense(name)) return;
    if (name == format::columns::kRun) runs = k;
  }
  const auto position = column_of_positions(table);
  if (!position) return;
  const Found found = stated_in(sheet, table);
  if (!found.any || found.stated.count) return;
  int count = 0;  // of runs
  for (std::size_t row = table.first_data; runs && row < sheet.rows.size(); ++row)
    count = std::max(count, number_of(sheet.rows[row][*runs]));
  std::vector<int> senses(sheet.rows.size(), 0);
  std::optional<double> before;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const auto at = sheet::number_at(sheet, row, *position);
    const bool all = found.stated.kind == Kind::kAll;
    senses[row] = found.stated.of(runs ? number_of(sheet.rows[row][*runs]) : 0, count);
    // All rows forward, and the rows go back: the text is about another thing.
    const bool against = all && !runs && before && at && *at < *before;
    if (senses[row] == 0 || against || (!all && !runs)) return note_unclear(sheet, found);
    before = at;
  }
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    sheet.rows[row].push_back(senses[row] == 0 ? "" : std::to_string(senses[row]));
  table.headings.push_back(heading_of_directions());
  sheet.written.clear();
  sheet.notes.push_back(fmt::format(
      "{} states the approach directions of {}{}; if this is wrong, add a column with the heading Richtung",
      named(found.text), runs ? "the runs" : "the rows", assumption(found)));
}

void apply_direction_codes(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes) {
  if (!table.has_headings || wishes.directions_from_order) return;
  const Guess guess(wishes);
  std::optional<std::size_t> column;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (!is_sense(guess.column(table.headings[k]).name)) continue;
    if (column) return;  // the text does not say which column it is about
    column = k;
  }
  if (!column) return;
  for (const TableText& one : sentences_about(sheet, table)) {
    const std::map<std::string, int> codes = direction_codes_stated(one.text);
    if (codes.empty()) continue;
    bool usual = true;  // + and 1 for forward: no word is necessary
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const std::string& cell = sheet.rows[row][*column];
      if (sheet::is_blank(sheet.rows[row]) || cell.empty()) continue;
      const auto code = codes.find(text::in_small_letters(cell));
      if (code == codes.end()) return;  // the text is about another column
      usual &= sense_said(cell) == code->second;
    }
    if (usual) return;
    std::string meaning;
    for (const auto& [code, sense] : codes)
      meaning += fmt::format("{}{} is {}", meaning.empty() ? "" : ", ", code, sense > 0 ? "forward" : "back");
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      std::string& cell = sheet.rows[row][*column];
      if (const auto code = codes.find(text::in_small_letters(cell)); code != codes.end())
        cell = code->second > 0 ? "+" : "-";
    }
    sheet.notes.push_back(fmt::format(
        "{} states the codes of \"{}\": {} (forward is the direction of increasing positions); if this is "
        "wrong, write + and - into this column",
        named(one), table.headings[*column].text, meaning));
    return;
  }
}

}  // namespace vernier::importer
