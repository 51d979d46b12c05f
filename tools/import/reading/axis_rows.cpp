// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/axis_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

enum class PerAxis { kNo, kTarget, kReading, kSense };

bool names_axis_column(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
  return words.size() == 1 && (words[0] == "achse" || words[0] == "axis" || words[0] == "axe");
}

/// The axis of a cell: "X", "x", "X-Achse"; empty for other texts.
std::string axis_of_cell(const std::string& cell, const Guess& guess) {
  std::string axis;
  for (const std::string& word : heading_words(cell)) {
    const std::string small = text::in_small_letters(word);
    if (small == "achse" || small == "axis") continue;
    std::string large = word;
    if (large.size() == 1 && large[0] >= 'a' && large[0] <= 'z')
      large[0] = static_cast<char>(large[0] - 'a' + 'A');
    if (!axis.empty() || !guess.is_axis(large)) return "";
    axis = large;
  }
  return axis;
}

PerAxis kind_of(const sheet::Heading& heading, const Guess& guess) {
  const SheetColumn column = guess.column(heading);
  if (column.use == SheetColumn::Use::kDeviation)
    return column.name.empty() ? PerAxis::kReading : PerAxis::kNo;
  if (column.use != SheetColumn::Use::kColumn || guess.is_axis(column.name)) return PerAxis::kNo;
  if (is_sense(column.name)) return guess.of_axis(column.name) ? PerAxis::kNo : PerAxis::kSense;
  switch (Guess::bare(heading.name)) {
    case Guess::Bare::kTarget:
      return PerAxis::kTarget;
    case Guess::Bare::kActual:
      return PerAxis::kReading;
    default:
      return PerAxis::kNo;
  }
}

/// The axes in the order of their rows, and the axis of each row of data (empty for a blank row).
struct AxisRows {
  std::size_t column = 0;
  std::vector<std::string> axes, of_row;
};

std::optional<AxisRows> axis_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                  const Guess& guess) {
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (!names_axis_column(table.headings[k])) continue;
    AxisRows found{k, {}, std::vector<std::string>(sheet.rows.size())};
    std::string axis;
    bool only_axes = true;
    for (std::size_t row = table.first_data; row < sheet.rows.size() && only_axes; ++row) {
      if (sheet::is_blank(sheet.rows[row])) continue;
      // An axis that only its first row names applies to the rows below.
      if (const std::string& cell = sheet.rows[row][k]; !cell.empty()) axis = axis_of_cell(cell, guess);
      only_axes = !axis.empty();
      found.of_row[row] = axis;
      if (std::find(found.axes.begin(), found.axes.end(), axis) == found.axes.end())
        found.axes.push_back(axis);
    }
    if (only_axes && !found.axes.empty()) return found;
  }
  return std::nullopt;
}

sheet::Heading heading_of_axis(const sheet::Heading& heading, const std::string& axis) {
  sheet::Heading one = heading;
  one.name = heading.name + " " + axis;
  one.text = heading.text.starts_with(heading.name) ? one.name + heading.text.substr(heading.name.size())
                                                    : heading.text + " " + axis;
  return one;
}

/// The constant position of an axis in the unit of the column of targets; empty: not stated.
std::string position_of(const std::string& axis, const std::string& unit, const SheetWishes& wishes,
                        bool comma) {
  for (const MappedColumn& one : wishes.constants) {
    if (one.name != axis) continue;
    std::string number = one.constant;
    std::replace(number.begin(), number.end(), ',', '.');
    const auto value = text::parse_number(number);
    const auto from = format::find_unit(one.unit), to = format::find_unit(unit);
    if (!value || !from || !to || from->dimension != to->dimension) return "";
    std::string text = text::fixed_text(*value * from->factor / to->factor, 9);
    if (comma) std::replace(text.begin(), text.end(), '.', ',');
    return text;
  }
  return "";
}

/// Refuses rows of several axes without the positions of the other axes.
void require_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table, const AxisRows& rows,
                       const SheetWishes& wishes, const std::string& unit) {
  std::string missing;
  for (const std::string& axis : rows.axes)
    if (position_of(axis, unit, wishes, false).empty())
      missing += fmt::format(" --set \"{}[{}]=0\"", axis, is_angle(unit) ? "deg" : "mm");
  if (missing.empty()) return;
  throw text::InputError(
      {sheet.file, sheet.line[table.heading_row]}, table.headings[rows.column].text,
      fmt::format(
          "the rows belong to the axes {} of this column, and a row needs the position of every axis: "
          "state where each axis stood while the others moved, for example{} (0 is an example)",
          text::joined(rows.axes, ", "), missing));
}

}  // namespace

bool unfold_axes(sheet::Sheet& sheet, sheet::SheetTable& table, SheetWishes& wishes, AxisCells cells_of) {
  if (!table.has_headings) return false;
  const Guess guess(wishes);
  const auto rows = axis_rows(sheet, table, guess);
  if (!rows) return false;
  if (cells_of == AxisCells::kInEachRow)
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (!sheet::is_blank(sheet.rows[row]) && sheet.rows[row][rows->column].empty()) return false;
  std::vector<PerAxis> kinds;
  std::size_t targets = 0, readings = 0, target = 0;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    kinds.push_back(k == rows->column ? PerAxis::kNo : kind_of(table.headings[k], guess));
    // A column that belongs to one axis already is no part of a table of this form.
    if (k != rows->column && kinds.back() == PerAxis::kNo) {
      const SheetColumn column = guess.column(table.headings[k]);
      if (guess.is_axis(column.name) || column.use == SheetColumn::Use::kDeviation) return false;
    }
    if (kinds.back() == PerAxis::kTarget) ++targets, target = k;
    readings += kinds.back() == PerAxis::kReading ? 1 : 0;
  }
  if (targets != 1 || readings == 0) return false;
  const std::string unit = table.headings[target].unit.empty() ? wishes.unit : table.headings[target].unit;
  if (rows->axes.size() > 1 && unit.empty())
    throw text::InputError(
        {sheet.file, sheet.line[table.heading_row]}, table.headings[target].text,
        "this column has no unit: write the unit into the heading ([mm]), or give --unit mm");
  if (rows->axes.size() > 1) require_positions(sheet, table, *rows, wishes, unit);
  std::vector<sheet::Heading> headings;
  std::vector<std::vector<std::string>> cells(sheet.rows.size());
  const auto add = [&](const sheet::Heading& heading, const auto& cell_of) {
    headings.push_back(heading);
    for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
      const bool data = row >= table.first_data && !rows->of_row[row].empty();
      cells[row].push_back(data ? cell_of(row) : "");
    }
  };
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto own = [&](std::size_t row) { return sheet.rows[row][k]; };
    if (kinds[k] == PerAxis::kNo) {
      if (k != rows->column) add(table.headings[k], own);
      continue;
    }
    for (const std::string& axis : rows->axes) {
      sheet::Heading heading = heading_of_axis(table.headings[k], axis);
      std::string other;
      if (kinds[k] == PerAxis::kTarget) other = position_of(axis, unit, wishes, sheet.decimal_comma);
      if (kinds[k] == PerAxis::kSense) {
        heading.text = heading.name = format::axis_column(format::AxisQuantity::kSense, axis);
        other = "0";  // no motion
      }
      add(heading, [&](std::size_t row) { return rows->of_row[row] == axis ? own(row) : other; });
    }
  }
  // Titles above the headings keep their cells.
  for (std::size_t row = 0; row < table.first_data; ++row) {
    std::vector<std::string> title = sheet.rows[row];
    title.resize(std::max(title.size(), headings.size()));
    const bool heading = row == table.heading_row || (table.upper_row && row >= *table.upper_row);
    cells[row] = heading ? std::vector<std::string>(headings.size()) : title;
  }
  std::size_t width = 0;
  for (const auto& row : cells) width = std::max(width, row.size());
  for (auto& row : cells) row.resize(width);
  while (headings.size() < width)
    headings.push_back(sheet::parse_heading(std::to_string(headings.size() + 1)));
  sheet.rows = std::move(cells);
  sheet.written.clear();
  sheet.notes.push_back(fmt::format(
      "the rows belong to the {} {} by the column \"{}\"{}", rows->axes.size() > 1 ? "axes" : "axis",
      text::joined(rows->axes, ", "), table.headings[rows->column].text,
      rows->axes.size() > 1 ? "; in the rows of another axis an axis has the position of --set" : ""));
  table.headings = std::move(headings);
  std::erase_if(wishes.constants, [&](const MappedColumn& one) {
    return rows->axes.size() > 1 &&
           std::find(rows->axes.begin(), rows->axes.end(), one.name) != rows->axes.end();
  });
  return true;
}

void refuse_unread_axes(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes,
                        bool assigned) {
  if (!table.has_headings) return;
  const Guess guess(wishes);
  const auto rows = axis_rows(sheet, table, guess);
  if (!rows || rows->axes.size() < 2) return;
  for (const sheet::Heading& heading : table.headings)
    if (guess.is_axis(guess.column(heading).name)) return;  // the positions of each axis have a column
  const std::string& heading = table.headings[rows->column].text;
  const std::string text = fmt::format(
      "this column names the axes {}, but the rows cannot be read axis by axis: this needs one column of "
      "positions and one of deviations without an axis in their headings ({};Soll [mm];Abweichung [um]). "
      "Change the headings, or write a table for each axis",
      text::joined(rows->axes, ", "), heading);
  if (!assigned) throw text::InputError({sheet.file, sheet.line[table.heading_row]}, heading, text);
  sheet.notes.push_back(fmt::format("\"{}\": {}", heading, text));
}

}  // namespace vernier::importer
