// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/distances/pair_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/dates.h"
#include "tools/sheet/encoding.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Known = std::vector<std::string>;

bool is_value(const std::string& word) {
  return sheet::plain_number(word, true) || sheet::plain_number(word, false);
}

/// The numbers behind the names of a line, with the unit behind them, as cells: "310.73; 310.75 mm". The
/// number behind ± stays in its cell ("310.73 ± 0.02"). Empty: other words.
std::vector<std::string> values_of(std::string text) {
  for (const std::string_view sign : {"+/-", "+-", "\u00b1"}) text::replace_all(text, sign, " \u00b1 ");
  std::vector<std::string> cells;
  bool tolerance = false;
  for (const std::string& word : text::words_in(text, " \t;/")) {
    const bool value = is_value(word);
    if (word == "\u00b1" && !cells.empty()) {
      cells.back() += " \u00b1";
      tolerance = true;
    } else if (tolerance && value) {
      cells.back() += " " + word;
      tolerance = false;
    } else if (value || sheet::number_and_unit(word, true) || sheet::number_and_unit(word, false)) {
      cells.push_back(word);
    } else if (!cells.empty() && sheet::unit_meant(word)) {
      if (is_value(cells.back())) cells.back() += " " + word;
    } else {
      return {};
    }
  }
  return cells;
}

/// A line such as "AC = 310.73 mm" as cells; empty: another line.
std::vector<std::string> pair_line(const std::string& line, const Known& known) {
  for (const char sign : {'=', ':'}) {
    const std::size_t at = line.find(sign);
    if (at == std::string::npos) continue;
    const std::string name = text::trimmed(line.substr(0, at));
    if (!two_points(name, known, false)) continue;
    std::vector<std::string> cells = values_of(line.substr(at + 1));
    if (cells.empty()) continue;
    cells.insert(cells.begin(), name);
    return cells;
  }
  // "AC 310.73 mm": without a unit, the line is a row of a table with blanks.
  const std::size_t blank = line.find_first_of(" \t");
  if (blank == std::string::npos || !sheet::unit_meant(line.substr(line.find_last_of(" \t") + 1)) ||
      !two_points(line.substr(0, blank), known, false))
    return {};
  std::vector<std::string> cells = values_of(line.substr(blank));
  if (!cells.empty()) cells.insert(cells.begin(), line.substr(0, blank));
  return cells;
}

/// The unit of the cells of one row is that of each cell without a unit in the same line ("170,1 / 170,2
/// mm").
void share_unit(std::vector<std::string>& cells) {
  const auto last = sheet::number_and_unit(cells.back(), cells.back().find(',') != std::string::npos);
  if (!last) return;
  for (std::size_t k = 1; k + 1 < cells.size(); ++k)
    if (is_value(cells[k])) cells[k] += " " + last->second;
}

/// A word of a heading that names an axis of the machine: X, "Soll X", "X-Achse".
bool names_axis(const std::string& cell) {
  const sheet::Heading heading = sheet::parse_heading(cell);
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word.size() == 1 && std::string_view("XYZxyz").find(word) != std::string_view::npos;
  });
}

/// A cell that begins with a number: "170,12", "170,12 mm", "170,12 schief".
bool begins_with_number(const std::string& cell) {
  const std::size_t at = cell.find_first_not_of("+-.,");
  return at != std::string::npos && cell[at] >= '0' && cell[at] <= '9';
}

bool has_value(const sheet::Sheet& sheet, std::size_t row, std::size_t but) {
  for (std::size_t k = 0; k < sheet.rows[row].size(); ++k)
    if (k != but && begins_with_number(sheet.rows[row][k])) return true;
  return false;
}

/// A column of pairs: its first row with a pair, and whether a heading above it says that it has pairs.
struct PairColumn {
  std::size_t column = 0, first = 0;
  bool sure = false;
};

/// A word above a cell, in its column, that names a distance: "Strecke [mm]" has positions, "Strecke" pairs.
bool heads_pairs(const sheet::Sheet& sheet, std::size_t column, std::size_t end) {
  for (std::size_t row = 0; row < end; ++row) {
    const sheet::Heading heading = sheet::parse_heading(sheet.rows[row][column]);
    if (!heading.unit.empty()) continue;
    for (const std::string& word : heading_words(text::in_small_letters(heading.name)))
      if (names_a_length(word)) return true;
    if (names_a_length(text::in_small_letters(heading.name))) return true;
  }
  return false;
}

std::size_t points_of(const std::set<PointPair>& pairs) {
  std::set<std::string> points;
  for (const PointPair& pair : pairs) points.insert({pair.first, pair.second});
  return points.size();
}

/// True for cells such as 12, 23, 34: numbers, which are pairs only if they close a figure.
bool are_numbers(const sheet::Sheet& sheet, std::size_t column, std::size_t first) {
  return sheet::plain_number(sheet.rows[first][column], sheet.decimal_comma).has_value();
}

std::optional<PairColumn> pair_column(const sheet::Sheet& sheet, const Known& known) {
  std::optional<PairColumn> best;
  std::size_t most = 0;
  for (std::size_t k = 0; k < sheet.rows.front().size(); ++k) {
    for (const bool sure : {false, true}) {
      std::size_t first = sheet.rows.size(), count = 0, others = 0;
      std::set<PointPair> pairs;
      for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
        const std::string& cell = sheet.rows[row][k];
        if (cell.empty() || !has_value(sheet, row, k)) continue;
        if (sure && first == sheet.rows.size() && !heads_pairs(sheet, k, row)) continue;
        const auto pair = two_points(cell, known, sure);
        // The number of a distance ("12") beside a value; a value in its place is no pair.
        if (!pair) {
          others += first < row ? 1 : 0;
          continue;
        }
        first = std::min(first, row);
        ++count;
        pairs.insert(std::minmax(pair->first, pair->second));
      }
      // Pairs in most of the rows. Without a heading or a name that says so, two different pairs at least: LR
      // and RL are directions.
      const std::size_t fewest = sure || !known.empty() ? 1 : 2;
      if (pairs.size() < fewest || count <= others || count <= most) continue;
      if (known.empty() && are_numbers(sheet, k, first) && points_of(pairs) > pairs.size()) continue;
      most = count;
      best = PairColumn{k, first, sure};
    }
  }
  return best;
}

/// Two columns with the first and the second points. The names move into the first column.
std::optional<PairColumn> join_two_columns(sheet::Sheet& sheet, std::optional<std::size_t>& second) {
  for (std::size_t row = 0; row + 1 < sheet.rows.size(); ++row)
    for (std::size_t k = 0; k < sheet.rows[row].size(); ++k) {
      if (!heads_end_of_pair(sheet.rows[row][k], true)) continue;
      for (std::size_t other = 0; other < sheet.rows[row].size(); ++other) {
        if (other == k || !heads_end_of_pair(sheet.rows[row][other], false)) continue;
        std::size_t first = sheet.rows.size();
        for (std::size_t below = row + 1; below < sheet.rows.size(); ++below) {
          std::string& from = sheet.rows[below][k];
          std::string& to = sheet.rows[below][other];
          if (from.empty() || to.empty() || from == to || !has_value(sheet, below, sheet.rows.size()))
            continue;
          if (!two_points(from + " -> " + to, {}, true)) continue;
          from += " -> " + to;
          to.clear();
          first = std::min(first, below);
        }
        if (first == sheet.rows.size()) continue;
        second = other;
        sheet.rows[row][k] += " / " + sheet.rows[row][other];
        sheet.rows[row][other].clear();
        return PairColumn{k, first, true};
      }
    }
  return std::nullopt;
}

/// A row of headings that are pairs: each column is a distance. The sheet is turned.
bool turn(sheet::Sheet& sheet, const Known& known) {
  for (std::size_t row = 0; row + 1 < sheet.rows.size(); ++row) {
    std::set<PointPair> pairs;
    std::size_t filled = 0, first = 0;
    for (std::size_t k = 0; k < sheet.rows[row].size(); ++k) {
      const std::string& cell = sheet.rows[row][k];
      filled += cell.empty() ? 0 : 1;
      const auto pair = two_points(sheet::parse_heading(cell).name, known, false);
      if (pair && pairs.insert(std::minmax(pair->first, pair->second)).second && pairs.size() == 1) first = k;
    }
    if (pairs.size() < 2 || 2 * pairs.size() < filled) continue;
    if (std::any_of(sheet.rows[row].begin(), sheet.rows[row].end(), names_axis)) return false;
    std::vector<std::size_t> below;
    for (std::size_t one = row + 1; one < sheet.rows.size(); ++one)
      if (has_value(sheet, one, first == 0 ? sheet.rows.size() : 0)) below.push_back(one);
    if (below.empty()) return false;
    std::vector<std::vector<std::string>> rows(sheet.rows.begin(),
                                               sheet.rows.begin() + static_cast<std::ptrdiff_t>(row));
    std::vector<std::size_t> lines(sheet.line.begin(), sheet.line.begin() + static_cast<std::ptrdiff_t>(row));
    std::vector<std::string> headings = {"Pair"};
    for (std::size_t i = 0; i < below.size(); ++i) {
      std::string label = first == 0 ? "" : sheet.rows[below[i]].front();
      // The number of a measurement, or no word at all.
      if (label.empty() || is_value(label)) label = fmt::format("Measured {}", i + 1);
      headings.push_back(label);
    }
    rows.push_back(headings);
    lines.push_back(sheet.line[row]);
    for (std::size_t k = first; k < sheet.rows[row].size(); ++k) {
      const sheet::Heading heading = sheet::parse_heading(sheet.rows[row][k]);
      if (!two_points(heading.name, known, false)) continue;
      std::vector<std::string> cells = {heading.name};
      for (const std::size_t one : below) {
        std::string cell = sheet.rows[one][k];
        if (!heading.unit.empty() && sheet::plain_number(cell, sheet.decimal_comma))
          cell += " " + heading.unit;
        cells.push_back(cell);
      }
      rows.push_back(std::move(cells));
      lines.push_back(sheet.line[row]);
    }
    std::size_t width = below.size() + 1;
    for (const auto& one : rows)
      for (std::size_t k = width; k < one.size(); ++k)
        if (!one[k].empty()) width = k + 1;
    for (auto& one : rows) one.resize(width);
    const std::size_t line = sheet.line[row];
    sheet.rows = std::move(rows);
    sheet.line = std::move(lines);
    sheet.written.clear();
    sheet.notes.push_back(fmt::format(
        "line {}: the headings are pairs of points: each column is one distance, and each row a measurement",
        line));
    return true;
  }
  return false;
}

/// The unit of the cells of each column, and the cells without it.
void take_units(sheet::Sheet& sheet, std::size_t first, PairSheet& found) {
  for (std::size_t k = 0; k < sheet.rows.front().size(); ++k)
    for (std::size_t row = first; row < sheet.rows.size(); ++row) {
      const auto both = sheet::number_and_unit(sheet.rows[row][k], sheet.decimal_comma);
      if (!both) continue;
      const auto unit = format::find_unit(both->second);
      if (!unit || unit->dimension != format::Dimension::kLength) continue;
      const auto known = found.units.emplace(k, both->second).first;
      if (known->second != both->second)
        throw text::InputError(
            {sheet.file, sheet.line[row]}, sheet.rows[row][k],
            fmt::format("this cell is in {}, and a cell above it in {}: write all cells of "
                        "the column in one unit",
                        both->second, known->second));
      sheet.rows[row][k] = both->first;
      if (sheet.decimal_comma) std::replace(sheet.rows[row][k].begin(), sheet.rows[row][k].end(), '.', ',');
    }
}

/// Cells of a column of pairs that a spreadsheet program changed to dates: "1-2" is the first of February.
void refuse_dates(const sheet::Sheet& sheet) {
  for (std::size_t k = 0; k < sheet.rows.front().size(); ++k)
    for (std::size_t row = 1; row < sheet.rows.size(); ++row)
      if (sheet::is_date(sheet.rows[row][k]) && heads_pairs(sheet, k, row) && has_value(sheet, row, k))
        throw text::InputError(
            {sheet.file, sheet.line[row]}, sheet.rows[row][k],
            "a date in a column of pairs of points: the spreadsheet program changes 1-2 to a date; give the "
            "points names with a letter (P1-P2), or the column the format of a text");
}

}  // namespace

std::string lines_of_pairs(const std::string& bytes, const std::vector<std::string>& known) {
  if (sheet::is_workbook(bytes)) return "";
  const std::string text = sheet::utf8_text(bytes);
  std::string result;
  std::size_t pairs = 0, others = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text::trimmed(text.substr(at, end - at));
    at = end + 1;
    std::vector<std::string> cells = pair_line(line, known);
    if (cells.empty()) {
      others += line.empty() ? 0 : 1;
      result += line;
    } else {
      ++pairs;
      share_unit(cells);
      result += text::joined(cells, ";");
    }
    result += "\n";
  }
  return pairs < 2 || pairs <= others ? "" : result;
}

std::optional<PairSheet> take_pairs(sheet::Sheet& sheet, const std::vector<std::string>& known) {
  if (sheet.rows.empty()) return std::nullopt;
  sheet::Sheet changed = sheet;
  PairSheet found;
  std::optional<PairColumn> column = join_two_columns(changed, found.second);
  if (!column) {
    refuse_dates(changed);
    column = pair_column(changed, known);
    if (!column && turn(changed, known)) column = pair_column(changed, known);
  }
  if (!column) return std::nullopt;
  // Headings of axes: the table has positions. A title with one cell is no heading.
  for (std::size_t row = 0; row < column->first; ++row) {
    const std::vector<std::string>& cells = changed.rows[row];
    if (std::count_if(cells.begin(), cells.end(), [](const auto& cell) { return !cell.empty(); }) > 1 &&
        std::any_of(cells.begin(), cells.end(), names_axis))
      return std::nullopt;
  }
  found.column = column->column;
  take_units(changed, column->first, found);
  std::string above;
  std::vector<std::size_t> drop;
  for (std::size_t row = column->first; row < changed.rows.size(); ++row) {
    std::string& cell = changed.rows[row][found.column];
    if (!has_value(changed, row, found.column)) continue;
    auto pair = two_points(cell, known, column->sure);
    // Repeated measurements often have the names in their first row only.
    if (cell.empty() && !found.pairs.empty()) {
      changed.notes.push_back(
          fmt::format("line {}: the row without a pair of points is a repeated "
                      "measurement of {} and {} above it",
                      changed.line[row], found.pairs.back().first, found.pairs.back().second));
      pair = found.pairs.back();
    }
    if (!pair) {
      const std::vector<std::string> words = plain_words(cell);
      if (std::any_of(words.begin(), words.end(), says_statistic)) continue;  // leave_computed_rows
      changed.notes.push_back(
          fmt::format("line {}: \"{}\" names no two points: the row is left out", changed.line[row], cell));
      drop.push_back(row);
      continue;
    }
    found.pairs.push_back(*pair);
    cell = std::to_string(found.pairs.size());
  }
  for (auto row = drop.rbegin(); row != drop.rend(); ++row) sheet::remove_row(changed, *row);
  sheet = std::move(changed);
  return found;
}

void restore_pair(std::string& cell, const PairSheet& pairs) {
  const auto number = text::parse_count(cell);
  if (number && *number >= 1 && *number <= pairs.pairs.size())
    cell = pairs.pairs[*number - 1].first + "-" + pairs.pairs[*number - 1].second;
}

}  // namespace vernier::importer
