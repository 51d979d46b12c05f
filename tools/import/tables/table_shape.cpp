// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/table_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/tables/computed_rows.h"
#include "tools/import/words/run_columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// True if a cell reads like the heading of a quantity: it has a unit, or a word for target, measured or
/// deviation.
bool is_heading_of_quantity(const std::string& cell, bool unit_required) {
  const sheet::Heading heading = sheet::parse_heading(cell);
  if (!heading.unit.empty()) return true;
  if (unit_required) return false;
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const std::string small = text::in_small_letters(word);
    return says_target(small) || says_measured(small) || says_deviation(small);
  });
}

std::vector<double> values_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const SheetColumn& column, std::size_t k) {
  const auto unit = format::find_unit(column.unit);
  std::vector<double> values;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma);
    if (const auto value = number ? text::parse_number(*number) : std::nullopt)
      values.push_back(*value * (unit && !column.unit.empty() ? unit->factor : 1));
  }
  return values;
}

/// Number of values that are multiples of 0.1.
std::size_t count_round(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double value) {
    return std::abs(10 * value - std::round(10 * value)) < 1e-6;
  }));
}

/// True if the first row of the data has the positions and each other row one run: "Lauf;0;50;100" above
/// "1 vor;0,1;4,4;7,1".
bool has_runs_in_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  constexpr std::size_t kFewest = 3;  // positions
  std::vector<std::size_t> rows;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) rows.push_back(row);
  if (table.has_headings || rows.size() < kFewest) return false;
  std::vector<double> positions;
  const std::vector<std::string>& first = sheet.rows[rows.front()];
  for (std::size_t k = 1; k < first.size(); ++k)
    if (const auto number = sheet::plain_number(first[k], sheet.decimal_comma))
      positions.push_back(*text::parse_number(*number));
  const bool has_number = first.front().find_first_of("0123456789") != std::string::npos;
  if (has_number || sense_said(first.front()) != 0 || positions.size() < kFewest ||
      positions.size() + 1 < first.size())
    return false;
  const bool rises =
      std::adjacent_find(positions.begin(), positions.end(), std::greater_equal<>()) == positions.end();
  const bool falls =
      std::adjacent_find(positions.begin(), positions.end(), std::less_equal<>()) == positions.end();
  return (rises || falls) && std::all_of(rows.begin() + 1, rows.end(), [&](std::size_t row) {
           const std::string& label = sheet.rows[row].front();
           const auto run = run_column(sheet::parse_heading(label));
           return says_computed_row(label) || (run && (run->sense != 0 || !run->run.empty()));
         });
}

}  // namespace

void refuse_transposed(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  if (has_runs_in_rows(sheet, table))
    throw text::InputError(
        {sheet.file, sheet.line[table.first_data]}, "",
        "the positions are in this row, and each row below is one run: the table is transposed, and the "
        "command reads a column for each run. Transpose it in the spreadsheet program (copy, paste special, "
        "transpose), write \"Soll X [mm]\" (the axis and its unit) above the positions and the unit behind "
        "the "
        "names of the runs (\"1 vor [um]\"), save it, and import it again");
  std::size_t rows = 0, labelled = 0;
  std::string labels;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::vector<std::string>& cells = sheet.rows[row];
    if (sheet::is_blank(cells)) continue;
    if (sheet::plain_number(cells.front(), sheet.decimal_comma) || cells.size() < 3) return;
    ++rows;
    // With a line of headings, words alone may be the labels of rows: "target", "actual".
    if (!is_heading_of_quantity(cells.front(), table.has_headings)) continue;
    ++labelled;
    if (labelled <= 2) labels += (labels.empty() ? "\"" : ", \"") + cells.front() + "\"";
  }
  if (labelled < 2 || 2 * labelled <= rows) return;
  throw text::InputError(
      {sheet.file, sheet.line[table.first_data]}, "",
      fmt::format(
          "the first column has the headings ({}), so each row of this table is a quantity, and the command "
          "reads quantities in columns: transpose the table in the spreadsheet program (copy, paste "
          "special, transpose), save it, and import it again",
          labels));
}

void leave_words_below(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  if (!table.has_headings) return;
  const auto is_number = [&](const std::string& cell) {
    return sheet::plain_number(cell, true) || sheet::plain_number(cell, false);
  };
  const auto is_text = [](const std::string& cell) {
    return std::count_if(cell.begin(), cell.end(), [](unsigned char c) { return std::isalpha(c) != 0; }) >= 3;
  };
  std::vector<std::string> notes;
  for (std::size_t row = sheet.rows.size(); row-- > table.first_data + 1;) {
    const std::vector<std::string>& cells = sheet.rows[row];
    // A row that the spreadsheet computed may be below or above a text: leave_computed_rows.
    if (std::any_of(cells.begin(), cells.end(), says_computed_row)) continue;
    if (!std::all_of(cells.begin(), cells.end(), is_missing)) {
      if (std::any_of(cells.begin(), cells.end(), is_number) ||
          std::none_of(cells.begin(), cells.end(), is_text) ||
          std::any_of(cells.begin(), cells.end(), sheet::begins_with_error_value))
        break;
      std::string words;
      for (const std::string& cell : cells)
        if (!cell.empty()) words += (words.empty() ? "" : " ") + cell;
      notes.push_back(
          fmt::format("line {}: \"{}\" is a text below the table and is omitted", sheet.line[row], words));
      sheet.remarks.push_back({sheet.line[row], words});
    }
    sheet::remove_row(sheet, row);
  }
  sheet.notes.insert(sheet.notes.end(), notes.rbegin(), notes.rend());
}

void note_exchanged_headings(sheet::Sheet& sheet, const sheet::SheetTable& table,
                             const std::vector<SheetColumn>& columns) {
  if (!table.has_headings) return;
  for (std::size_t target = 0; target < columns.size(); ++target)
    for (std::size_t actual = 0; actual < columns.size(); ++actual) {
      const SheetColumn &a = columns[target], &b = columns[actual];
      if (a.use != SheetColumn::Use::kColumn || b.use != SheetColumn::Use::kColumn ||
          a.why != "by its heading" || b.why != "by its heading" || reading_of(a.name) != b.name)
        continue;
      const std::vector<double> targets = values_of(sheet, table, a, target),
                                actuals = values_of(sheet, table, b, actual);
      const std::set<double> different(actuals.begin(), actuals.end());
      constexpr std::size_t kEnough = 3;  // fewer positions show no pattern
      if (different.size() < kEnough || count_round(actuals) < actuals.size() ||
          2 * count_round(targets) >= targets.size())
        continue;
      const std::string &one = table.headings[target].text, &other = table.headings[actual].text;
      sheet.notes.push_back(fmt::format(
          "the values of \"{1}\" are round numbers, and the values of \"{0}\" are not: the two headings may "
          "be exchanged; if they are, give --column \"{2}={1}\" --column \"{3}={0}\"",
          one, other, a.name, b.name));
    }
}

}  // namespace vernier::importer
