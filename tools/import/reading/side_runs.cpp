// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/side_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/reading/verdict_columns.h"
#include "tools/import/tables/run_units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// "Lauf 1 Pos [mm]": the run, and the heading without it; nullopt for other headings.
std::optional<std::pair<std::string, sheet::Heading>> heading_of_run(const sheet::Heading& heading) {
  const std::vector<std::string> words = text::words_in(heading.text, " \t");
  if (words.size() < 3 || !says_run(text::in_small_letters(words[0])) || !is_run_number(words[1]))
    return std::nullopt;
  std::string rest;
  for (std::size_t k = 2; k < words.size(); ++k) rest += (k == 2 ? "" : " ") + words[k];
  return std::pair(words[1], sheet::parse_heading(rest));
}

/// A heading of one of several runs side by side: run and direction, and the heading without them.
struct SideHeading {
  std::size_t column = 0;
  std::string run;
  int sense = 0;
  sheet::Heading rest;
  bool position = false;

  std::pair<std::string, int> key() const { return {run, sense}; }
  bool keyed() const { return !run.empty() || sense != 0; }
};

bool has_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet.rows[row][k].empty()) return true;
  return false;
}

bool is_position(const sheet::Heading& heading) {
  const SheetWishes usual;
  const Guess guess(usual);
  return Guess::bare(heading.name) == Guess::Bare::kTarget || guess.is_axis(guess.column(heading).name);
}

/// "Lauf 1 Pos [mm]", "Run 1 fwd Pos", "1+ Pos", "Dev Run 2".
SideHeading side_heading(const sheet::Heading& heading, std::size_t column) {
  SideHeading found;
  found.column = column;
  const std::vector<std::string> words = text::words_in(heading.text, " \t");
  std::string rest;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string small = text::in_small_letters(words[k]);
    const bool next_number = k + 1 < words.size() && is_run_number(words[k + 1]);
    const std::string digits = small.substr(0, small.size() - 1);
    const bool signed_run =
        small.size() > 1 && (small.back() == '+' || small.back() == '-') && is_run_number(digits);
    if (found.run.empty() && says_run(small) && next_number) {
      found.run = words[++k];
    } else if (found.run.empty() && found.sense == 0 && signed_run) {
      found.run = digits;
      found.sense = small.back() == '+' ? 1 : -1;
    } else if (found.sense == 0 && !is_run_number(small) && !says_target(small) && sense_said(small) != 0) {
      found.sense = sense_said(small);
    } else {
      rest += (rest.empty() ? "" : " ") + words[k];
    }
  }
  found.rest = sheet::parse_heading(rest);
  if (found.rest.name.empty() || rest.starts_with('[') || rest.starts_with('(')) {
    found.rest = heading;
    found.rest.name.clear();
  }
  found.position = !found.rest.name.empty() && is_position(found.rest);
  return found;
}

/// Positions without a run belong to the run behind them; the same headings again and again are runs 1, 2, 3.
void add_missing_keys(std::vector<SideHeading>& list) {
  if (std::none_of(list.begin(), list.end(), [](const SideHeading& one) { return one.keyed(); })) {
    std::map<std::string, int> count;
    for (SideHeading& one : list) one.run = std::to_string(++count[one.rest.text]);
    return;
  }
  for (std::size_t k = 0; k + 1 < list.size(); ++k)
    if (!list[k].keyed() && list[k].position && list[k + 1].keyed()) {
      list[k].run = list[k + 1].run;
      list[k].sense = list[k + 1].sense;
    }
}

/// A reading whose heading has only the direction ("hin [um]") is a deviation if its unit is smaller than
/// that of the positions; false: not known.
bool name_readings(std::vector<SideHeading>& list) {
  for (SideHeading& one : list) {
    if (!one.rest.name.empty()) continue;
    const auto position =
        std::find_if(list.begin(), list.end(), [](const SideHeading& other) { return other.position; });
    const auto unit = one.rest.unit.empty() ? std::nullopt : format::find_unit(one.rest.unit);
    const auto of_position = position == list.end() || position->rest.unit.empty()
                                 ? std::nullopt
                                 : format::find_unit(position->rest.unit);
    if (!unit || !of_position || unit->factor >= of_position->factor) return false;
    one.rest.name = "Deviation";  // the text remains that of the file
  }
  return true;
}

/// The runs of a table with one group of columns for each; empty: the table has another form.
struct SideGroups {
  std::vector<std::pair<std::string, int>> order;
  std::map<std::pair<std::string, int>, std::vector<SideHeading>> of;
  std::vector<std::size_t> computed;  // columns of means
  std::vector<std::size_t> shared;    // columns of remarks, which are about the rows of all runs
};

SideGroups groups_of(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  SideGroups groups;
  std::vector<SideHeading> list;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (!has_cells(sheet, table, k)) continue;
    if (names_statistic(table.headings[k]))
      groups.computed.push_back(k);
    else if (names_remark(table.headings[k]))
      groups.shared.push_back(k);
    else
      list.push_back(side_heading(table.headings[k], k));
  }
  add_missing_keys(list);
  if (!name_readings(list)) return {};
  std::size_t positions = 0;
  for (SideHeading& one : list) {
    if (!one.keyed()) return {};
    positions += one.position ? 1 : 0;
    if (!groups.of.contains(one.key())) groups.order.push_back(one.key());
    groups.of[one.key()].push_back(std::move(one));
  }
  if (groups.order.size() < 2 || positions != groups.order.size()) return {};
  const std::vector<SideHeading>& first = groups.of[groups.order.front()];
  for (const auto& [key, columns] : groups.of) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      names.insert(columns[i].rest.name);
      if (columns.size() != first.size() || columns[i].rest.name != first[i].rest.name) return {};
    }
    // Runs and directions are stated for all of the groups, or for none.
    const bool alike = key.first.empty() == groups.order.front().first.empty() &&
                       (key.second == 0) == (groups.order.front().second == 0);
    if (names.size() != columns.size() || columns.size() < 2 || !alike) return {};
  }
  return groups;
}

/// Converts columns with the same meaning to the unit of the first run.
void settle_side_units(sheet::Sheet& sheet, sheet::SheetTable& table, const SideGroups& groups) {
  const std::vector<SideHeading>& first = groups.of.at(groups.order.front());
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::vector<std::size_t> columns;
    for (const auto& key : groups.order) {
      columns.push_back(groups.of.at(key)[i].column);
      table.headings[columns.back()].unit = groups.of.at(key)[i].rest.unit;
    }
    const auto other = std::find_if(columns.begin(), columns.end(), [&](std::size_t k) {
      return table.headings[k].unit != first[i].rest.unit;
    });
    if (other != columns.end() && !convert_to_one_unit(sheet, table, columns))
      throw text::InputError(
          {sheet.file, sheet.line[table.heading_row]}, table.headings[*other].text,
          fmt::format("the runs are side by side, and this column has another unit than \"{}\": convert the "
                      "values of one of the two columns, and write the same unit in both headings",
                      table.headings[first[i].column].text));
  }
}

/// Writes the groups one below the other, with a column for the run and one for the direction.
void stack(sheet::Sheet& sheet, sheet::SheetTable& table, SideGroups& groups) {
  const bool runs = !groups.order.front().first.empty(), senses = groups.order.front().second != 0;
  std::vector<std::vector<std::string>> rows(
      sheet.rows.begin(), sheet.rows.begin() + static_cast<std::ptrdiff_t>(table.first_data));
  std::vector<std::size_t> line(sheet.line.begin(),
                                sheet.line.begin() + static_cast<std::ptrdiff_t>(table.first_data));
  for (const auto& key : groups.order)
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      std::vector<std::string> cells;
      for (const SideHeading& one : groups.of[key]) cells.push_back(sheet.rows[row][one.column]);
      if (sheet::is_blank(cells)) continue;  // a shorter run
      for (const std::size_t k : groups.shared) cells.push_back(sheet.rows[row][k]);
      if (senses) cells.push_back(std::to_string(key.second));
      if (runs) cells.push_back(key.first);
      rows.push_back(std::move(cells));
      line.push_back(sheet.line[row]);
    }
  for (const std::size_t k : groups.computed)
    sheet.notes.push_back(fmt::format("the column \"{}\" is computed from the runs beside it and is omitted",
                                      table.headings[k].text));
  std::vector<sheet::Heading> headings;
  const std::vector<SideHeading>&first = groups.of[groups.order.front()],
        &last = groups.of[groups.order.back()];
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool same = first[i].rest.text == last[i].rest.text;
    headings.push_back(same ? first[i].rest
                            : heading_of_joined(first[i].rest, first[i].rest.text, last[i].rest.text));
  }
  for (const std::size_t k : groups.shared) headings.push_back(table.headings[k]);
  if (senses) headings.push_back(heading_of_directions());
  if (runs) headings.push_back(heading_of_runs());
  std::size_t width = headings.size();
  for (std::size_t row = 0; row < table.first_data; ++row) width = std::max(width, rows[row].size());
  for (auto& row : rows) row.resize(width);
  while (headings.size() < width)
    headings.push_back(sheet::parse_heading(std::to_string(headings.size() + 1)));
  table.headings = std::move(headings);
  sheet.rows = std::move(rows);
  sheet.line = std::move(line);
  sheet.written.clear();
  std::vector<std::string> names;
  for (const auto& [run, sense] : groups.order)
    names.push_back(run + (sense > 0 ? "+" : sense < 0 ? "-" : ""));
  sheet.notes.push_back(
      fmt::format("the runs {} are side by side, each with its own positions: their rows are read one run "
                  "below the other, "
                  "with a column {}",
                  text::joined(names, ", "),
                  runs && senses ? "run and a column of directions"
                  : runs         ? "run"
                                 : "of directions"));
}

/// Runs with the same headings behind the word for the run; a group may have positions for each direction.
/// Empty: the table has another form.
SideGroups whole_runs_of(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  SideGroups groups;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (!has_cells(sheet, table, k)) continue;
    if (names_remark(table.headings[k])) {
      groups.shared.push_back(k);
      continue;
    }
    auto one = heading_of_run(table.headings[k]);
    if (!one) return {};
    SideHeading heading;
    heading.column = k;
    heading.run = std::move(one->first);
    heading.rest = std::move(one->second);
    if (!groups.of.contains(heading.key())) groups.order.push_back(heading.key());
    groups.of[heading.key()].push_back(std::move(heading));
  }
  if (groups.order.size() < 2) return {};
  const std::vector<SideHeading>& first = groups.of[groups.order.front()];
  const bool positions =
      std::any_of(first.begin(), first.end(), [](const SideHeading& one) { return is_position(one.rest); });
  if (!positions) return {};  // one column of positions for all runs: unfold_runs
  for (const auto& [key, columns] : groups.of)
    if (!std::equal(first.begin(), first.end(), columns.begin(), columns.end(),
                    [](const SideHeading& a, const SideHeading& b) { return a.rest.text == b.rest.text; }))
      return {};
  return groups;
}

}  // namespace

bool stack_runs(sheet::Sheet& sheet, sheet::SheetTable& table) {
  if (!table.has_headings) return false;
  SideGroups groups = whole_runs_of(sheet, table);
  if (!groups.order.empty()) {
    stack(sheet, table, groups);
    return true;
  }
  groups = groups_of(sheet, table);
  if (groups.order.empty()) return false;
  // Two directions with positions in their headings: unfold_runs.
  const auto& first = groups.of[groups.order.front()];
  const bool named = std::all_of(first.begin(), first.end(), [&](const SideHeading& one) {
    return side_heading(table.headings[one.column], one.column).keyed();
  });
  if (named && groups.order.front().first.empty()) return false;
  settle_side_units(sheet, table, groups);
  stack(sheet, table, groups);
  return true;
}

}  // namespace vernier::importer
