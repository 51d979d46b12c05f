// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/sheet_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_axes.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/column_signs.h"
#include "tools/import/columns/column_values.h"
#include "tools/import/columns/doubled.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/title_units.h"
#include "tools/sheet/dates.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;

const std::string kSensePrefix = format::entry_of(format::AxisQuantity::kSense).prefix;

enum class Holds {
  kNothing,
  kNumbers,
  kWords,
  kDates
};  // words, dates: in most of the cells that are filled

Holds holds(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  std::size_t words = 0, dates = 0, filled = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    filled += is_missing(cell) ? 0 : 1;
    dates += sheet::is_date(cell) ? 1 : 0;
    words += !is_missing(cell) && !sheet::plain_number(cell, sheet.decimal_comma) ? 1 : 0;
  }
  if (filled == 0) return Holds::kNothing;
  if (2 * dates > filled) return Holds::kDates;
  return 2 * words > filled ? Holds::kWords : Holds::kNumbers;
}

/// True if most of the filled cells are a number with its unit: "0,5 mm".
bool holds_units(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  std::size_t units = 0, filled = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    filled += is_missing(cell) ? 0 : 1;
    units += sheet::number_and_unit(cell, sheet.decimal_comma) ? 1 : 0;
  }
  return 2 * units > filled;
}

/// True if most of the filled cells are numbers, some of them with the other decimal sign.
bool holds_other_sign(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  std::size_t numbers = 0, filled = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    filled += is_missing(cell) ? 0 : 1;
    numbers += sheet::plain_number(cell, true) || sheet::plain_number(cell, false) ? 1 : 0;
  }
  return 2 * numbers > filled;
}

/// A column of words that no known name claims labels its rows.
bool keeps_words(const SheetColumn& column, const Guess& guess) {
  return column.use == SheetColumn::Use::kColumn && !is_known_name(column.name) && !is_sense(column.name) &&
         !guess.is_axis(column.name) && !guess.is_motion(column.name);
}

/// The measured axes: a direction without an axis belongs to the only measured axis, also if others have
/// positions.
std::set<std::string> measured_axes(const std::vector<SheetColumn>& columns,
                                    const std::set<std::string>& axes,
                                    const std::set<std::string>& measured) {
  if (axes.size() == 1) return axes;
  std::set<std::string> moved;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kDeviation && axes.contains(column.name)) moved.insert(column.name);
  for (const std::string& axis : axes)
    if (measured.contains(text::in_small_letters(axis))) moved.insert(axis);
  return moved;
}

/// The unit in a heading, or in the row of units, is a fact of the file: an assignment with another unit is a
/// mistake in one of the two.
void refuse_another_unit(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t at,
                         const SheetWishes::Assignment& wish) {
  const sheet::Heading& heading = table.headings[at];
  if (wish.column.unit.empty() || heading.unit.empty() || wish.column.unit == heading.unit) return;
  if (heading.unit == "in" && wish.column.unit == "arcsec" && heading.text.find('"') != std::string::npos)
    return;  // the sign " has both meanings
  throw text::InputError(
      wish.place.file.empty() ? text::Place{sheet.file, sheet.line[table.heading_row]} : wish.place,
      heading.text,
      fmt::format("the table states the unit {}, the assignment to {} states {}: omit the unit in the "
                  "assignment, or correct the heading",
                  heading.unit, wish.column.name, wish.column.unit));
}

/// Why a column with a difference of both approach directions ("Umkehrspanne") is omitted from readings of
/// one direction; empty: it is no such column, or the other columns have both directions.
std::string why_reversal_is_left(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns,
                                 std::size_t column) {
  const std::string small = text::in_small_letters(table.headings[column].name);
  if (small.find("umkehr") == std::string::npos && small.find("reversal") == std::string::npos) return "";
  const Readings readings(columns);
  std::string axis, heading;
  std::size_t count = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use == SheetColumn::Use::kColumn && is_sense(columns[k].name)) return "";
    if (names_statistic(table.headings[k]) ||
        (columns[k].use != SheetColumn::Use::kDeviation && !readings.contain(columns[k])))
      continue;
    ++count;
    axis = columns[k].name;
    heading = table.headings[k].text;
  }
  if (count != 1) return "";
  for (const SheetColumn& one : columns)  // the heading of the readings names no axis
    if (axis.empty() && one.use == SheetColumn::Use::kColumn && one.name.size() == 1) axis = one.name;
  if (axis.size() == 1) axis[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(axis[0])));
  return fmt::format(
      "the difference of both approach directions, and \"{0}\" has one direction: no other column shows the "
      "way "
      "back. Write a second column of readings into the file (vor - Umkehrspanne = rück, ISO 230-2), or "
      "state "
      "the direction of \"{0}\" (--set \"{1}=1\"; -1: back)",
      heading, format::axis_column(format::AxisQuantity::kSense, axis));
}

/// The mean or the spread of the readings in the columns beside it is no further reading.
void leave_statistics(const sheet::SheetTable& table, std::vector<SheetColumn>& columns) {
  const Readings readings(columns);
  bool reading = false;
  for (std::size_t k = 0; k < columns.size(); ++k)
    reading |= !names_statistic(table.headings[k]) &&
               (columns[k].use == SheetColumn::Use::kDeviation || readings.contain(columns[k]) ||
                Guess::bare(table.headings[k].name) == Guess::Bare::kActual);
  for (std::size_t k = 0; reading && k < columns.size(); ++k)
    if (columns[k].why == "by its heading" && names_statistic(table.headings[k])) {
      const std::string reversal = why_reversal_is_left(table, columns, k);
      leave_column(columns[k], reversal.empty()
                                   ? "this column is computed from the readings in the other columns"
                                   : reversal);
    }
}

/// True if the positions of an axis are lengths.
bool is_linear(const std::vector<SheetColumn>& columns, const std::string& axis) {
  return std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    const auto unit = one.unit.empty() ? std::nullopt : format::find_unit(one.unit);
    return one.use == SheetColumn::Use::kColumn && one.name == axis && unit &&
           unit->dimension == format::Dimension::kLength;
  });
}

/// True if the positions of an axis are angles.
bool rotates(const std::vector<SheetColumn>& columns, const std::string& axis) {
  return std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis && is_angle(one.unit);
  });
}

/// The sign " is the unit arcsec beside positions of A, B and C that are no lengths (the unit may be one that
/// is not known, such as gon), and inch elsewhere.
void settle_arcseconds(std::vector<SheetColumn>& columns, const Guess& guess) {
  std::string only;
  std::size_t axes = 0;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name)) {
      ++axes;
      only = column.name;
    }
  for (SheetColumn& column : columns) {
    if (column.unit != "in" || column.use == SheetColumn::Use::kLeft) continue;
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    for (const char* const axis : {"A", "B", "C"}) {
      const bool of_axis = deviation
                               ? column.name == axis || (column.name.empty() && axes == 1 && only == axis)
                               : column.name == *reading_of(axis);
      if (of_axis && !is_linear(columns, axis)) column.unit = "arcsec";
    }
  }
}

/// A deviation beside a measured position of the same axis: one of the two is the reading.
void settle_beside_reading(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           std::vector<SheetColumn>& columns, std::size_t deviation,
                           std::set<std::string>& measured) {
  const std::string reading = *reading_of(columns[deviation].name);
  const auto named = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find_if(columns.begin(), columns.end(),
                                                 [&](const SheetColumn& one) {
                                                   return one.use == SheetColumn::Use::kColumn &&
                                                          one.name == name;
                                                 }) -
                                    columns.begin());
  };
  const std::size_t target = named(columns[deviation].name), position = named(reading);
  const bool compares =
      target < columns.size() && position < columns.size() && columns[position].why == "by its heading";
  if (!compares)
    leave_column(columns[deviation],
                 fmt::format("the table already has the measured position, as the column {}", reading));
  else if (settle_doubled(sheet, table, columns, {target, position, deviation}))
    measured.erase(reading);
}

/// Deviations and directions without an axis belong to the only axis; columns that remain open are omitted
/// and reported.
void settle(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
            const Guess& guess, const std::vector<MappedColumn>& constants) {
  std::set<std::string> axes, measured;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn)
      (guess.is_axis(column.name) ? axes : measured).insert(column.name);
  std::set<std::string> positions = axes;  // of the axes that stand still too
  for (const MappedColumn& constant : constants)
    if (guess.is_axis(constant.name)) positions.insert(constant.name);
  std::set<std::string> moved = measured_axes(columns, axes, measured), alone_measured;
  for (const char* axis : {"X", "Y", "Z"})
    if (guess.is_axis(axis) && !axes.contains(axis) && measured.contains(text::in_small_letters(axis)))
      alone_measured.insert(axis);
  if (moved.empty()) moved = alone_measured;
  const std::string to_try = axis_to_try(sheet, table);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    const Holds content = holds(sheet, table, k);
    const bool no_numbers = content == Holds::kWords || content == Holds::kDates;
    if (no_numbers && keeps_words(column, guess)) {
      column.words = true;
      column.unit.clear();
    }
    if (column.why != "by its heading" && !column.by_values) continue;
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    if (deviation && column.name.empty() && axes.size() == 1) column.name = *axes.begin();
    if (deviation && column.name.empty() && axes.empty() && alone_measured.size() == 1)
      column.name = *alone_measured.begin();
    if (deviation && !axes.contains(column.name) && alone_measured.contains(column.name))
      column.to_target = true;
    else if (deviation && !column.name.empty() && !positions.contains(column.name) && reading_of(column.name))
      leave_column(column, fmt::format("the table has no position of {}: state the position, for example {}",
                                       column.name, set_position(column)));
    else if (deviation && column.name.empty())
      leave_column(column,
                   fmt::format("the axis of this deviation is not known: state the axis, --deviation "
                               "\"{}={}\"{}",
                               to_try, table.headings[k].text,
                               positions.empty()
                                   ? fmt::format(" {} (with the position of {})",
                                                 option_of_positions(sheet, table, columns, guess, k), to_try)
                                   : ""));
    else if (deviation && !reading_of(column.name))
      leave_column(column,
                   fmt::format("no reading of a measurement file is along {}: state the axis that it is "
                               "parallel to, --deviation \"X={}\"{}",
                               column.name, table.headings[k].text,
                               positions.contains("X") ? "" : " --set \"X[mm]=0\" (with its position)"));
    else if (deviation && measured.contains(*reading_of(column.name)))
      settle_beside_reading(sheet, table, columns, k, measured);
    else if (column.name == kSensePrefix && moved.size() == 1)
      column.name = format::axis_column(format::AxisQuantity::kSense, *moved.begin());
    else if (column.name == kSensePrefix)
      leave_column(column,
                   fmt::format("the axis of this approach direction is not known: state the axis, --column "
                               "\"dir{}={}\"",
                               to_try, table.headings[k].text));
    else if (column.name == columns::kTime && content == Holds::kDates)
      leave_column(column, "this column has dates or times of day, not seconds");
    // Dates where a position or a reading should be are refused with their row.
    else if (!column.words && !is_label(column.name) && !is_sense(column.name) &&
             content != Holds::kNumbers && content != Holds::kDates && !holds_units(sheet, table, k) &&
             !holds_other_sign(sheet, table, k))  // such cells are refused with their row
      leave_column(column, content == Holds::kNothing ? "empty" : "no numbers");
  }
}

/// Titles state the units of deviations and positions whose headings have none: "Abweichungen in µm",
/// "Positionen in mm". The note is written by the caller, from `unit_from`.
void take_units_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          std::vector<SheetColumn>& columns, const SheetWishes& wishes, const Guess& guess) {
  if (!wishes.unit.empty()) return;  // the user states the unit
  const TitleUnits titles = units_of_titles(sheet, table);
  // The positions first: the unit of an axis shows whether it rotates.
  for (const auto use : {SheetColumn::Use::kColumn, SheetColumn::Use::kDeviation})
    for (std::size_t k = 0; k < columns.size(); ++k) {
      SheetColumn& column = columns[k];
      const bool deviation = use == SheetColumn::Use::kDeviation;
      const TitleUnit& stated = deviation ? titles.deviations : titles.positions;
      if (column.use != use || stated.unit.empty() || !column.unit.empty() ||
          !table.headings[k].unknown_unit.empty() || !wants_unit(column))
        continue;
      const bool reading = column.name.size() == 1 && !guess.is_axis(column.name);
      if (!deviation && !guess.is_axis(column.name) && !reading) continue;
      if (deviation && is_angle(stated.unit) != rotates(columns, column.name)) continue;
      column.unit = stated.unit;
      column.unit_from = stated.title;
    }
}

/// The same name twice: an index column or a remark that reads like another.
void keep_names_apart(const sheet::SheetTable& table, std::vector<SheetColumn>& columns) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn) continue;
    const auto [first, fresh] = seen.emplace(column.name, k);
    if (fresh) continue;
    const bool plain = column.why == "by its heading";
    SheetColumn& one = plain ? column : columns[first->second];
    if (!plain) first->second = k;
    leave_column(
        one, fmt::format("column {} (\"{}\") is already read as {}; to read this column instead: --leave "
                         "{}, or another name: --column \"NAME[unit]={}\"",
                         std::to_string(first->second + 1), table.headings[first->second].text, column.name,
                         std::to_string(first->second + 1), std::to_string((&one - columns.data()) + 1)));
  }
}

}  // namespace

std::string set_position(const SheetColumn& deviation) {
  const bool angle =
      is_angle(deviation.unit) || (deviation.unit.empty() && format::angle_about(deviation.name));
  return fmt::format("--set \"{}[{}]=0\"", deviation.name, angle ? "deg" : "mm");
}

std::vector<SheetColumn> columns_by_headings(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const SheetWishes& wishes) {
  const Guess guess(wishes);
  std::vector<SheetColumn> columns;
  for (const sheet::Heading& heading : table.headings) {
    columns.push_back(guess.column(heading));
    if (has_mean_bar(heading.text))
      leave_column(columns.back(), "the bar above the letter is the sign of a mean");
  }
  for (const SheetWishes::Assignment& wish : wishes.assignments) {
    const std::size_t at = find_heading(table, wish.heading);
    if (at == std::string::npos) {
      if (wish.column.use == SheetColumn::Use::kLeft) continue;  // one that this file does not have
      throw text::InputError(wish.place, wish.heading, "no column of " + sheet.file + " has this heading");
    }
    refuse_another_unit(sheet, table, at, wish);
    columns[at] = wish.column;
    if (columns[at].unit.empty()) columns[at].unit = table.headings[at].unit;
    columns[at].why = wish.place.file.empty() ? "as given" : "by the profile";
  }
  settle_axes(sheet, table, columns, guess);
  return columns;
}

std::vector<SheetColumn> columns_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const SheetWishes& wishes) {
  const Guess guess(wishes);
  std::vector<SheetColumn> columns = columns_by_headings(sheet, table, wishes);
  leave_statistics(table, columns);
  settle_arcseconds(columns, guess);
  settle_by_values(sheet, table, columns);
  settle(sheet, table, columns, guess, wishes.constants);
  if (!wishes.one_motion) refuse_tables_side_by_side(sheet, table, columns);
  settle_signs(sheet, table, columns, wishes);
  keep_names_apart(table, columns);
  if (table.has_headings) take_units_of_titles(sheet, table, columns, wishes, guess);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (!column.unit.empty() || wishes.unit.empty() || !wants_unit(column)) continue;
    // A heading with an unknown unit, such as "0,5 um", is not one without a unit.
    if (!table.headings[k].unknown_unit.empty()) continue;
    // A unit for all headings without one is for lengths or angles, not for temperatures and loads.
    const std::string& name = column.name;
    const bool length = guess.is_axis(name) || column.use == SheetColumn::Use::kDeviation ||
                        (name.size() <= 2 && name != columns::kTime) || name == columns::kLength;
    if (length) column.unit = wishes.unit;
  }
  return columns;
}

}  // namespace vernier::importer
