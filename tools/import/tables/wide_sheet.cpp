// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/wide_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/stated_order.h"
#include "tools/import/tables/run_pairs.h"
#include "tools/import/tables/run_positions.h"
#include "tools/import/tables/run_signs.h"
#include "tools/import/tables/run_units.h"
#include "tools/import/words/run_columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/title_units.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Runs without a number are counted in their order, if a direction occurs more than once.
void number_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<RunColumn>& runs) {
  const bool numbered =
      std::any_of(runs.begin(), runs.end(), [](const RunColumn& one) { return !one.run.empty(); });
  std::map<int, int> count;
  std::set<std::pair<std::string, int>> seen;
  for (RunColumn& one : runs) {
    if (!numbered) one.run = std::to_string(++count[one.sense]);
    if (!seen.emplace(one.run, one.sense).second)
      throw text::InputError({sheet.file, sheet.line[table.heading_row]}, table.headings[one.column].text,
                             "the table contains this run twice in the same approach direction");
  }
}

double spread_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  double least = 0, most = 0;
  bool any = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, column);
    if (!value) continue;
    least = any ? std::min(least, *value) : *value;
    most = any ? std::max(most, *value) : *value;
    any = true;
  }
  return most - least;
}

/// Kind of the readings, as a heading of one column that the import understands.
sheet::Heading heading_of_readings(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                   const std::vector<RunColumn>& runs,
                                   const std::vector<std::size_t>& others) {
  RunColumn all = runs.front();
  std::string unknown;  // a unit that the formats do not have
  for (const RunColumn& one : runs) {
    if (unknown.empty()) unknown = table.headings[one.column].unknown_unit;
    all.deviation |= one.deviation;
    all.measured |= one.measured;
    all.turned |= one.turned;
    all.length |= one.length;
    if (all.unit.empty()) all.unit = one.unit;
  }
  for (const std::string& title : title_cells(sheet, table)) {
    if (names_deviation(title)) all.deviation = all.deviation || !all.measured;
    if (!all.unit.empty() || !unknown.empty()) continue;
    const sheet::Heading stated = unit_of_deviations_in(title);
    all.unit = stated.unit;
    unknown = stated.unknown_unit;
    if (!stated.unit.empty()) sheet.notes.push_back(note_of_title_unit("deviations", {stated.unit, title}));
  }
  if (!all.deviation && !all.measured) {
    // Readings that go as far as the positions do are positions.
    const double read = spread_of(sheet, table, runs.front().column);
    for (const std::size_t other : others) {
      const std::vector<std::string> words = heading_words(table.headings[other].name);
      const bool deviation = std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return says_deviation(text::in_small_letters(word));
      });
      if (deviation || names_statistic(table.headings[other])) continue;  // a mean of the runs
      const double ratio = spread_of(sheet, table, other) > 0 ? read / spread_of(sheet, table, other) : 0;
      if (!(ratio > 0.9 && ratio < 1.1)) continue;
      all.measured = true;
      if (all.unit.empty() && unknown.empty()) all.unit = table.headings[other].unit;
    }
  }
  sheet::Heading heading;
  heading.name = std::string(all.measured && !all.deviation ? "Actual" : "Deviation") +
                 (all.axis.empty() ? "" : " " + all.axis);
  heading.unit = unknown.empty() ? all.unit : "";
  heading.unknown_unit = unknown;
  // The headings of the runs state the sign too.
  return heading_of_joined(heading, table.headings[runs.front().column].text,
                           table.headings[runs.back().column].text);
}

/// Returns 1 if the positions increase from row to row, -1 if they decrease, else 0. `enough`: with fewer
/// rows the result is 0. `run`: only the rows with a reading of this column count; the column of the
/// positions itself for all rows.
int order_of_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t position,
                       std::size_t enough, std::size_t run) {
  std::optional<double> before;
  std::size_t rows = 0;
  int order = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, position);
    if (!value || sheet.rows[row][run].empty()) continue;
    if (before) {
      const int step = *value > *before ? 1 : *value < *before ? -1 : 0;
      if (step == 0 || (order != 0 && step != order)) return 0;
      order = step;
    }
    before = value;
    ++rows;
  }
  return rows >= enough ? order : 0;
}

/// True if the positions decrease from row to row.
bool positions_decrease(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t position) {
  constexpr std::size_t kEnough = 3;  // fewer rows show no order
  return order_of_positions(sheet, table, position, kEnough, position) < 0;
}

/// A table whose positions decrease from row to row. "hin" is the way that the rows go, as in a table with
/// one row for each reading: the two directions are exchanged, with a note. Up and down, and directions with
/// positions of their own, only get the note.
void settle_decreasing_positions(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                 std::vector<RunColumn>& runs, std::size_t position, bool own_positions) {
  const auto forth =
      std::find_if(runs.begin(), runs.end(), [](const RunColumn& one) { return one.sense > 0; });
  if (std::none_of(runs.begin(), runs.end(), [](const RunColumn& one) { return one.relative; })) return;
  if (forth == runs.end() || !positions_decrease(sheet, table, position)) return;
  const std::string heading = table.headings[forth->column].text;
  const bool words = std::all_of(runs.begin(), runs.end(), [](const RunColumn& one) { return one.forth; });
  if (words && !own_positions)
    for (RunColumn& one : runs) one.sense = -one.sense;
  sheet.notes.push_back(fmt::format(
      "\"{}\" is read as the approach in the direction of {} positions, and the positions of the table "
      "decrease from row to row; if this approach ran toward {} positions, write {} in its heading and {} in "
      "the heading of the other approach",
      heading, words && !own_positions ? "decreasing" : "increasing",
      words && !own_positions ? "larger" : "smaller", words && !own_positions ? "+" : "-",
      words && !own_positions ? "-" : "+"));
}

bool belong_together(const std::vector<RunColumn>& runs) {
  if (runs.size() < 2) return false;
  bool pos = false, back = false;
  for (const RunColumn& one : runs) {
    if (one.axis != runs.front().axis || one.run.empty() != runs.front().run.empty()) return false;
    if (one.deviation != runs.front().deviation || one.turned != runs.front().turned) return false;
    if (one.unit != runs.front().unit) return false;
    pos |= one.pos;
    back |= one.sense < 0;
  }
  return !pos || back;  // "Pos" without its counterpart is a position
}

/// Runs in several units are converted to the unit of the first one, if they belong together otherwise.
void settle_run_units(sheet::Sheet& sheet, sheet::SheetTable& table, std::vector<RunColumn>& runs) {
  std::vector<RunColumn> alike = runs;
  for (RunColumn& one : alike) one.unit = runs.front().unit;
  std::vector<std::size_t> columns;
  for (const RunColumn& one : runs) columns.push_back(one.column);
  if (belong_together(alike) && convert_to_one_unit(sheet, table, columns)) runs = std::move(alike);
}

/// Positions of their own for each direction ("X Soll hin", "X Soll rück"): returns their columns by the
/// direction, and leaves one of the two in `others`, with a heading for both. Empty: one column of positions.
std::map<int, std::size_t> positions_by_direction(sheet::Sheet& sheet, sheet::SheetTable& table,
                                                  std::vector<std::size_t>& others) {
  std::map<int, std::size_t> found;
  std::map<int, sheet::Heading> bare;
  for (const std::size_t k : others) {
    auto [sense, heading] = position_of_direction(table.headings[k]);
    if (sense == 0) continue;
    if (!found.emplace(sense, k).second)
      throw text::InputError({sheet.file, sheet.line[table.heading_row]}, table.headings[k].text,
                             "a second column of positions in this approach direction: write one table for "
                             "each run");
    bare.emplace(sense, std::move(heading));
  }
  if (found.size() != 2 || bare.at(1).name != bare.at(-1).name || bare.at(1).unit != bare.at(-1).unit)
    return {};
  sheet.notes.push_back(
      fmt::format("the readings of each approach direction belong to its positions, \"{}\" and \"{}\"",
                  table.headings[found.at(1)].text, table.headings[found.at(-1)].text));
  table.headings[found.at(1)] = bare.at(1);
  std::erase(others, found.at(-1));
  return found;
}

/// "Pos" beside runs with numbers is a position, at the left or behind them.
void take_positions_out(std::vector<RunColumn>& runs, std::vector<std::size_t>& others) {
  const bool numbered =
      std::any_of(runs.begin(), runs.end(), [](const RunColumn& one) { return !one.run.empty(); });
  for (const RunColumn& one : runs)
    if (numbered && one.pos && one.run.empty()) others.push_back(one.column);
  std::erase_if(runs, [&](const RunColumn& one) { return numbered && one.pos && one.run.empty(); });
  std::sort(others.begin(), others.end());
}

/// "X hin" and "X rück" are positions if other columns have the readings of both directions: "Abw hin", "Abw
/// rück".
void take_directed_positions_out(const sheet::SheetTable& table, std::vector<RunColumn>& runs,
                                 std::vector<std::size_t>& others) {
  const auto bare = [&](const RunColumn& one) {
    return !one.axis.empty() && one.run.empty() && !one.deviation && !one.measured && one.sense != 0 &&
           position_of_direction(table.headings[one.column]).first != 0;
  };
  std::set<int> of_positions, of_readings;
  std::size_t positions = 0;
  for (const RunColumn& one : runs) {
    (bare(one) ? of_positions : of_readings).insert(one.sense);
    positions += bare(one) ? 1 : 0;
  }
  constexpr std::size_t kBoth = 2;  // directions
  if (of_positions.size() != kBoth || of_readings.size() != kBoth || positions != kBoth) return;
  for (const RunColumn& one : runs)
    if (bare(one)) others.push_back(one.column);
  std::erase_if(runs, bare);
  std::sort(others.begin(), others.end());
}

/// Headings that are the numbers 1 to n without a word or a unit, behind another column: runs.
void take_numbered_columns(const sheet::SheetTable& table, std::vector<RunColumn>& runs,
                           std::vector<std::size_t>& others) {
  if (!runs.empty()) return;
  std::vector<RunColumn> numbered;
  for (const std::size_t k : others) {
    const sheet::Heading& heading = table.headings[k];
    if (k == 0 || heading.name != std::to_string(numbered.size() + 1) || !heading.unknown_unit.empty())
      continue;
    RunColumn one;
    one.column = k;
    one.run = heading.name;
    one.unit = heading.unit;
    numbered.push_back(std::move(one));
  }
  constexpr std::size_t kFewest = 2;  // one number may be the name of a column
  if (numbered.size() < kFewest || numbered.size() + 1 < others.size()) return;
  runs = std::move(numbered);
  std::erase_if(others, [&](std::size_t k) {
    return std::any_of(runs.begin(), runs.end(), [&](const RunColumn& one) { return one.column == k; });
  });
}

/// Notes a run whose first reading alone is empty: the first sign of a column that is shifted by a row and
/// cut off at the end.
void note_late_run(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  constexpr std::size_t kFewestRows = 5;  // a short run may begin anywhere
  std::size_t rows = 0, empty = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    ++rows;
    empty += sheet.rows[row][column].empty() ? 1 : 0;
  }
  if (rows < kFewestRows || empty != 1 || !sheet.rows[table.first_data][column].empty()) return;
  sheet.notes.push_back(
      fmt::format("\"{}\" (column {}) is empty in line {} only, the first row: if the column is shifted by "
                  "one row against "
                  "the positions, move it; otherwise the row has no reading",
                  table.headings[column].text, column + 1, sheet.line[table.first_data]));
}

}  // namespace

std::size_t unfold_runs(sheet::Sheet& sheet, sheet::SheetTable& table, const SheetWishes& wishes) {
  if (!table.has_headings) return 0;
  say_directions_of_pairs(sheet, table);
  std::vector<RunColumn> runs;
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    auto one = run_column(table.headings[k]);
    // "Pos" at the left, or beside a direction, is where the machine was sent.
    if (one && one->pos && one->run.empty() &&
        (k == 0 || position_of_direction(table.headings[k]).first != 0))
      one.reset();
    if (one) {
      one->column = k;
      runs.push_back(std::move(*one));
    } else {
      others.push_back(k);
    }
  }
  take_positions_out(runs, others);
  take_directed_positions_out(table, runs, others);
  take_numbered_columns(table, runs, others);
  if (!others.empty() && !runs.empty()) settle_run_units(sheet, table, runs);
  if (others.empty() || !belong_together(runs)) return 0;
  const std::map<int, std::size_t> positions = positions_by_direction(sheet, table, others);
  number_runs(sheet, table, runs);
  take_stated_directions(sheet, table, wishes, runs);
  // The two directions of an axis may have opposite values: only runs of one direction are compared.
  std::map<int, std::vector<std::size_t>> of_direction;
  for (const RunColumn& one : runs) of_direction[one.sense].push_back(one.column);
  for (const auto& [sense, columns] : of_direction) note_unsigned_runs(sheet, table, columns);
  const std::size_t position = positions_of_runs(sheet, table, others, wishes);
  if (positions.empty()) turn_runs_back(sheet, table, runs, position);
  settle_decreasing_positions(sheet, table, runs, position, !positions.empty());
  constexpr std::size_t kMostCells = 8u << 20;  // 64 MB of numbers
  const std::size_t width = others.size() + 3, data = sheet.rows.size() - table.first_data;
  if (data > kMostCells / width / runs.size())
    throw text::InputError(
        {sheet.file, sheet.line[table.heading_row]}, "",
        fmt::format("the table has too many cells, because each row becomes one row for each of {} runs",
                    runs.size()));
  // Runs of a survey without approach directions have none, and no column of directions.
  const bool directed =
      std::any_of(runs.begin(), runs.end(), [](const RunColumn& one) { return one.sense != 0; });
  for (const RunColumn& one : runs)
    if (directed && one.sense == 0)
      throw text::InputError({sheet.file, sheet.line[table.heading_row]}, table.headings[one.column].text,
                             "the heading of this run has no approach direction, but the headings of the "
                             "other runs have one: write + or - behind the number of the run");
  const sheet::Heading readings = heading_of_readings(sheet, table, runs, others);
  std::vector<sheet::Heading> headings;
  for (const std::size_t k : others) headings.push_back(table.headings[k]);
  if (directed) headings.push_back(heading_of_directions());
  headings.push_back(heading_of_runs());
  headings.push_back(readings);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> line;
  for (std::size_t row = 0; row < table.first_data; ++row) {
    rows.push_back(sheet.rows[row]);
    line.push_back(sheet.line[row]);
  }
  // A run against the order of the rows was read from the last row to the first: the rows of a measurement
  // file have the order of their readings.
  for (const RunColumn& one : runs) {
    note_late_run(sheet, table, one.column);
    const auto own_positions = positions.find(one.sense);
    const int order = order_of_positions(
        sheet, table, own_positions == positions.end() ? position : own_positions->second, 2, one.column);
    for (std::size_t count = 0; count < data; ++count) {
      const std::size_t row = table.first_data + (one.sense * order < 0 ? data - 1 - count : count);
      if (sheet.rows[row][one.column].empty()) continue;
      std::vector<std::string> cells;
      for (const std::size_t k : others) {
        const bool own = positions.contains(one.sense) && k == positions.at(1);
        cells.push_back(sheet.rows[row][own ? positions.at(one.sense) : k]);
      }
      if (directed) cells.push_back(std::to_string(one.sense));
      cells.push_back(one.run);
      cells.push_back(sheet.rows[row][one.column]);
      rows.push_back(std::move(cells));
      line.push_back(sheet.line[row]);
    }
  }
  if (rows.size() == table.first_data) return 0;
  sheet.rows = std::move(rows);
  sheet.line = std::move(line);
  sheet.written.clear();
  table.headings = std::move(headings);
  return runs.size();
}

}  // namespace vernier::importer
