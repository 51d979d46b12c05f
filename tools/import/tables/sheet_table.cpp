// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/sheet_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/column_values.h"
#include "tools/import/columns/sheet_columns.h"
#include "tools/import/columns/values_beside.h"
#include "tools/import/tables/assignments_to_try.h"
#include "tools/import/tables/order_directions.h"
#include "tools/import/tables/points_alone.h"
#include "tools/import/tables/run_pairs.h"
#include "tools/import/words/joint_names.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/dates.h"
#include "tools/sheet/several_tables.h"
#include "tools/sheet/sheet_number.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Words = std::set<std::string>;
namespace columns = format::columns;

bool is_linear(const std::string& axis) { return axis == "X" || axis == "Y" || axis == "Z"; }

/// The largest absolute value of a column of numbers.
double largest_value(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  double largest = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma);
    if (const auto value = number ? text::parse_number(*number) : std::nullopt)
      largest = std::max(largest, std::abs(*value));
  }
  return largest;
}

/// Suggested unit for a deviation without one: of a rotary axis arcsec, of a linear axis um or mm by the size
/// of the values.
std::string unit_of_deviation(const std::vector<SheetColumn>& columns, const std::string& axis,
                              double largest) {
  const bool rotary = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis &&
           (one.unit.empty() ? !is_linear(axis) : is_angle(one.unit));
  });
  if (rotary) return "arcsec";
  // Instruments resolve 0.1 um at best, and errors of machines are below 0.5 mm: small values are mm.
  constexpr double kSmallest = 0.5;
  return largest < kSmallest ? "mm" : "um";
}

/// Says that only the user knows the unit of a deviation: the other usual unit, and the largest value.
std::string unit_doubt(const SheetColumn& column, const std::string& heading, const std::string& unit,
                       double largest) {
  const std::string other = unit == "arcsec" ? "deg" : unit == "um" ? "mm" : "um";
  return fmt::format(
      ", or --deviation \"{0}[{1}]={2}\": only you know the unit of \"{2}\"; its largest value {3:.4g} is "
      "{3:.4g} {4} or {3:.4g} {1}{5}",
      column.name, other, heading, largest, unit,
      unit == "arcsec" ? "" : " (divisions of a dial gauge: [0.01mm])");
}

/// Suggested unit for a column without one: that of the format, for an axis mm or deg.
std::string unit_to_say(const std::string& name, const std::vector<SheetColumn>& columns) {
  const std::string unit = format::column_unit(name);
  if (!unit.empty()) return unit;
  const bool letter =
      name.size() <= 2 && (name[0] == 'A' || name[0] == 'B' || name[0] == 'C' || name[0] == 'J');
  const bool length = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    const auto found = format::find_unit(one.unit);
    return one.use == SheetColumn::Use::kDeviation && one.name == name && found &&
           found->dimension == format::Dimension::kLength && !one.unit.empty();
  });
  return letter && !length ? "deg" : "mm";
}

/// The quantities that a column of this role may hold; empty: any. A machine's axes are linear or rotary, and
/// so are its deviations and uncertainties.
std::vector<format::Dimension> quantities_of(const SheetColumn& column, const Guess& guess) {
  using format::Dimension;
  const std::string& name = column.name;
  const std::vector<Dimension> either = {Dimension::kLength, Dimension::kAngle};
  if (column.use == SheetColumn::Use::kDeviation) return either;
  if (guess.may_be_no_axis(name)) return {};
  if (guess.is_axis(name)) return either;
  if (guess.is_motion(name)) {
    const format::AxisQuantity quantity = guess.of_axis(name)->quantity;
    const Dimension linear = format::dimension_of(quantity, false),
                    rotary = format::dimension_of(quantity, true);
    return linear == rotary ? std::vector{linear} : std::vector{linear, rotary};
  }
  const format::ColumnGroup* const known = format::find_column(name);
  if (known == nullptr || known->later || known->words) return {};
  std::vector<Dimension> list = {format::dimension_of(*known)};
  if (const auto other = format::other_dimension_of(*known)) list.push_back(*other);
  return list;
}

/// A length in bar, or an angle in seconds of time, is refused with the required unit.
void check_quantity(const SheetColumn& column, const Guess& guess, const std::string& heading,
                    const text::Place& place) {
  if (column.use == SheetColumn::Use::kLeft || column.words || column.unit.empty()) return;
  const std::vector<format::Dimension> allowed = quantities_of(column, guess);
  const auto unit = format::find_unit(column.unit);
  if (allowed.empty() || !unit) return;
  if (std::find(allowed.begin(), allowed.end(), unit->dimension) != allowed.end()) return;
  std::string needs;
  for (const format::Dimension one : allowed)
    needs += (needs.empty() ? "" : " or ") + std::string(format::base_unit(one));
  const bool pure = needs.empty();
  const bool deviation = column.use == SheetColumn::Use::kDeviation;
  const bool slope = deviation && column.unit == "um/m";
  throw text::InputError(
      place, heading,
      fmt::format(
          "[{}] is no unit of {}{}, which needs {}{}", column.unit, deviation ? "a deviation of " : "",
          column.name, pure ? "a pure number" : "a unit like " + needs,
          slope ? "; if the values are deviations for each metre of travel, multiply each of "
                  "them in the file by its distance from the first position in m, and write "
                  "[um]; if they are slopes of a level, they are angles: write [urad] in the heading "
                  "(1 um/m is 1 urad), and give --column \"ry=HEADING\" with the new heading, and rx, "
                  "ry or rz for the axis of the rotation"
                : ""));
}

/// Approach directions as numbers: 1 and -1, 0 without motion. In the heading of a user who counts 1 and 0,
/// or 1 and 2, the second number is the other direction. `dirX` of the measurement file keeps its meaning.
void settle_senses(const sheet::Sheet& sheet, const std::vector<std::size_t>& rows, bool own_name,
                   std::vector<std::string>& cells) {
  Words found(cells.begin(), cells.end());
  found.erase("");
  if (!own_name && (found == Words{"0", "1"} || found == Words{"1", "2"}))
    for (std::string& cell : cells)
      if (cell == "0" || cell == "2") cell = "-1";
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (const std::string& cell = cells[i]; !cell.empty() && cell != "0" && cell != "1" && cell != "-1")
      throw text::InputError(
          {sheet.file, rows[i]}, cell,
          "an approach direction is 1 or -1 (0: no motion), or a word such as forward or back");
}

/// The angle that a rotary axis turns by, as the measurement file names it.
std::string angle_of(const std::string& axis, const text::Place& place) {
  if (auto angle = format::angle_about(axis)) return *angle;
  throw text::InputError(
      place, axis,
      "this column is a deviation in degrees: state its direction, for example --column \"rz[deg]=HEADING\"");
}

/// What the user does about an empty cell of a position: the value above applies only in a table that writes
/// each position once for several rows.
std::string remedy_of_empty_position(std::size_t empty, std::size_t filled, const std::string& heading) {
  constexpr std::size_t kFewestEmpty = 2;        // a single one was forgotten
  constexpr std::size_t kMostFilledForEach = 3;  // one empty cell for three filled ones, or more
  const bool written_once = empty >= kFewestEmpty && kMostFilledForEach * empty >= filled;
  return written_once ? "if the value above it applies, give --fill " + heading
                      : "write the position into this cell";
}

std::string remedy_of_empty_position(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                     std::size_t column) {
  std::size_t empty = 0, filled = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) ++(sheet.rows[row][column].empty() ? empty : filled);
  return remedy_of_empty_position(empty, filled, "\"" + table.headings[column].text + "\"");
}

/// A row with a reading needs the position of every axis that has a column.
void refuse_readings_without_position(const ImportTable& table, const Guess& guess) {
  std::vector<SheetColumn> all;
  for (const ImportTable::Column& column : table.columns)
    all.push_back({SheetColumn::Use::kColumn, column.name, column.unit, ""});
  const Readings readings(all);
  for (const ImportTable::Column& axis : table.columns) {
    if (!guess.is_axis(axis.name) || guess.may_be_no_axis(axis.name)) continue;
    const auto empty = static_cast<std::size_t>(std::count(axis.cells.begin(), axis.cells.end(), ""));
    for (std::size_t row = 0; row < table.line.size(); ++row) {
      if (!axis.cells[row].empty()) continue;
      for (std::size_t k = 0; k < all.size(); ++k)
        if (readings.contain(all[k]) && !table.columns[k].cells[row].empty())
          throw text::InputError(
              {table.file, table.line[row]}, axis.name,
              fmt::format(
                  "the position of this axis is empty in a row with a reading; {}; if the readings are "
                  "shifted by one row against the positions, move their column",
                  remedy_of_empty_position(empty, axis.cells.size() - empty,
                                           "with the heading of the column")));
    }
  }
}

/// Refuses tables side by side, of which each needs a call.
void refuse_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const std::vector<sheet::TableBeside> tables = sheet::tables_side_by_side(sheet);
  if (tables.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < tables.size(); ++i)
    list += fmt::format("{}--table {} (\"{}\", columns {} to {})", list.empty() ? "" : ", ", i + 1,
                        tables[i].title, tables[i].first + 1, tables[i].end);
  throw text::InputError(
      {sheet.file, sheet.line[table.heading_row]}, "",
      fmt::format("the sheet has {} tables side by side: import each with {}, then give all "
                  "files to the command",
                  tables.size(), list));
}

/// The one approach direction whose columns or runs a text about the sign names: "rück". Empty: none, or
/// both. "Minus", "positiv" and "vor dem Ziel" are words of a text about all readings.
std::string direction_of_sign_text(const std::string& text) {
  static const std::set<std::string> kReadings = {"spalte", "spalten",   "column", "columns",
                                                  "lauf",   "läufe",     "laeufe", "run",
                                                  "runs",   "messreihe", "reihen"};
  static const std::set<std::string> kAmbiguous = {"vor", "hin", "her", "zur"};
  std::string named;
  bool readings = false, both = false;
  for (const std::string& word : plain_words(text)) {
    readings |= kReadings.contains(word);
    if (!says_way(word) || kAmbiguous.contains(word)) continue;
    both |= !named.empty() && sense_said(named) != sense_said(word);
    named = word;
  }
  return readings && !both ? named : "";
}

/// Refuses deviations whose sign a text states, but not clearly.
void refuse_unclear_signs(const std::vector<SheetColumn>& columns) {
  for (const SheetColumn& column : columns) {
    if (column.use != SheetColumn::Use::kDeviation || column.sign_text.empty()) continue;
    const std::string direction = column.sign_of_row ? "" : direction_of_sign_text(column.sign_text);
    if (!direction.empty())
      throw text::InputError(
          column.sign_place, column.sign_text,
          fmt::format("this text may state another sign for the readings of one direction ({}), and --sign "
                      "would reverse those of both: if their sign is not that of the other readings, reverse "
                      "these values in the file; then delete this text",
                      direction));
    throw text::InputError(
        column.sign_place, column.sign_text,
        column.sign_of_row ? "this remark of a row may state that the sign of the deviations changes "
                             "here: reverse the sign of these values in the file, and delete the remark; "
                             "if it is about all rows, give --sign actual-nominal or --sign "
                             "nominal-actual"
                           : "this text does not state clearly whether the deviations are actual - nominal "
                             "or nominal - actual: give --sign actual-nominal or --sign nominal-actual");
  }
}

/// Refuses columns whose values contradict their unit or their direction.
void refuse_doubtful(const std::vector<SheetColumn>& columns) {
  for (const SheetColumn& column : columns)
    if (column.use != SheetColumn::Use::kLeft && !column.doubt.empty())
      throw text::InputError(column.doubt_place, column.doubt_word, column.doubt);
}

/// Refuses deviations without their signs: "Betrag der Abweichung" in the heading or in a title, and no value
/// below zero.
void refuse_magnitudes(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SheetColumn>& columns) {
  const auto refuse = [](const text::Place& place, const std::string& text) {
    throw text::InputError(
        place, text,
        "the deviations are magnitudes, and a magnitude has no sign: import the values with their signs, or "
        "leave the column out (--leave); if the values have signs, correct this text");
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kDeviation) continue;
    bool below = false;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma);
      const auto value = number ? text::parse_number(*number) : std::nullopt;
      below |= value && *value < 0;
    }
    if (below) continue;
    if (says_magnitude(table.headings[k].text))
      refuse({sheet.file, sheet.line[table.heading_row]}, table.headings[k].text);
    for (const std::string& title : title_cells(sheet, table))
      if (says_magnitude_of_deviation(title)) refuse({sheet.file, sheet.line.front()}, title);
  }
}

/// Refuses a column without a unit whose cells have one.
void refuse_units_in_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][k];
    if (sheet::plain_number(cell, sheet.decimal_comma)) return;
    if (const auto both = sheet::number_and_unit(cell, sheet.decimal_comma))
      throw text::InputError({sheet.file, sheet.line[row]}, cell,
                             fmt::format("the cells of \"{}\" have a unit: write the unit in the heading "
                                         "([{}]), numbers alone in the cells",
                                         table.headings[k].text, both->second));
  }
}

/// The joints of a robot without units, all of them within a turn in radians.
struct BareJoints {
  std::string names;  // "A1 to A6"; empty: there are none
  bool within_a_turn = false;
};

BareJoints bare_joints(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SheetColumn>& columns) {
  constexpr double kTurn_rad = 6.2832;  // a whole turn, rounded up
  BareJoints joints;
  std::vector<std::string> names;
  double largest = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!columns[k].unit.empty()) continue;
    names.push_back(columns[k].name);
    if (is_angle(unit_to_say(columns[k].name, columns)))
      largest = std::max(largest, largest_value(sheet, table, k));
  }
  joints.names = joint_series(names);
  joints.within_a_turn = !joints.names.empty() && largest <= kTurn_rad;
  return joints;
}

/// Refuses positions and readings without a unit, with the options that state the units.
void refuse_without_units(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SheetColumn>& columns, const Readings& readings,
                          const Guess& guess) {
  const text::Place heading{sheet.file, sheet.line[table.heading_row]};
  std::string without, doubt;
  bool other_than_deviation = false;  // one unit for all would decide the unit of the deviations as well
  Words units;                        // suggested for the columns without one
  // Deviations in parts of an inch: the positions are in inches.
  const bool inches = std::any_of(columns.begin(), columns.end(), [](const SheetColumn& one) {
    return one.unit == "in" || one.unit == "thou" || one.unit == "uin" || one.unit == "0.0001in";
  });
  const BareJoints joints = bare_joints(sheet, table, columns);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    const bool geometry = guess.is_axis(column.name) ||
                          ((is_known_name(column.name) || readings.contain(column)) && wants_unit(column));
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    if (!wants_unit(column) || !column.unit.empty() || (!deviation && !geometry)) continue;
    if (const std::string& unknown = table.headings[k].unknown_unit; !unknown.empty())
      throw text::InputError(
          heading, table.headings[k].text,
          fmt::format("{}; convert the values to a known unit, or, if they already are in one, state it in "
                      "place of UNIT: --{} \"{}[UNIT]={}\"; known are {}",
                      sheet::has_factor(unknown)
                          ? fmt::format("the unit [{}] has a factor that is not known", unknown)
                          : fmt::format("[{}] is no known unit", unknown),
                      deviation ? "deviation" : "column", column.name, table.headings[k].text,
                      format::known_units()));
    refuse_units_in_cells(sheet, table, k);
    const double largest = largest_value(sheet, table, k);
    std::string unit =
        deviation ? unit_of_deviation(columns, column.name, largest) : unit_to_say(column.name, columns);
    if (!deviation && inches && !is_angle(unit)) unit = "in";
    if (!deviation && joints.within_a_turn && is_angle(unit)) unit = "rad";
    if (deviation) doubt += unit_doubt(column, table.headings[k].text, unit, largest);
    other_than_deviation |= !deviation;
    units.insert(unit);
    without += fmt::format(" {} \"{}[{}]={}\"", deviation ? "--deviation" : "--column", column.name, unit,
                           table.headings[k].text);
  }
  if (without.empty()) return;
  const bool stated = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& column) {
    return column.use != SheetColumn::Use::kLeft && !column.unit_from.empty() && !units.contains(column.unit);
  });  // --unit would take the place of the unit of a title
  const bool one = units.size() == 1 && !stated && (doubt.empty() || !other_than_deviation);
  if (joints.within_a_turn)
    doubt += fmt::format(
        "; no value of {} is larger than a turn in radians: [rad] is proposed, write [deg] "
        "if the values are degrees",
        joints.names);
  if (!joints.names.empty())
    doubt += fmt::format(
        "; if {} are the joints of a robot, give the machine file of the robot too (--machine MACHINE): the "
        "command then states the call that assigns the columns to its axes",
        joints.names);
  if (const std::string points = points_alone(sheet, table, columns); !points.empty()) doubt += "; " + points;
  throw text::InputError(
      heading, "",
      fmt::format("no unit: give it for {}each, such as{}{}",
                  one ? fmt::format("all (--unit {}) or for ", *units.begin()) : "", without, doubt));
}

/// Refuses positions without a unit whose values are their numbers: "Position" with 1, 2, 3.
void refuse_numbers_of_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                 const std::vector<SheetColumn>& columns, const Guess& guess) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SheetColumn::Use::kColumn && guess.is_axis(columns[k].name) &&
        columns[k].unit.empty() && Guess::bare(table.headings[k].name) == Guess::Bare::kTarget &&
        numbers_positions(sheet, table, k))
      throw text::InputError({sheet.file, sheet.line[table.heading_row]}, table.headings[k].text,
                             text_of_numbered_positions(table.headings[k]));
}

/// Refuses a column that was left out because its cells are no numbers, although its heading says what it is:
/// names the first cell that cannot be read. `is_wanted`: true for the column that is missing.
template <typename Test>
void refuse_unreadable(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SheetColumn>& columns, const Test& is_wanted) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kLeft || columns[k].why != "no numbers" || !is_wanted(k))
      continue;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const std::string& cell = sheet.rows[row][k];
      if (is_missing(cell) || sheet::plain_number(cell, sheet.decimal_comma)) continue;
      throw text::InputError({sheet.file, sheet.line[row]}, cell,
                             fmt::format("this cell of \"{}\" is not a plain number: write the cells of this "
                                         "column as numbers such as 100{}5, without words and with the unit "
                                         "in the heading",
                                         table.headings[k].text, sheet.decimal_comma ? "," : "."));
    }
  }
}

/// Refuses a table whose headings are the positions: each row is a run.
void refuse_positions_in_headings(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  constexpr std::size_t kFewest = 3;  // fewer numbers may be names of columns
  std::size_t numbers = 0;
  std::string first;
  for (const sheet::Heading& heading : table.headings)
    if (!heading.unit.empty() && sheet::plain_number(heading.name, sheet.decimal_comma)) {
      if (++numbers == 1) first = heading.text;
    }
  if (numbers < kFewest || !table.has_headings) return;
  throw text::InputError(
      {sheet.file, sheet.line[table.heading_row]}, first,
      "the headings of the columns are positions, so that each row is a run: transpose the table in the "
      "spreadsheet program (copy, paste special, transpose), with one row for each position, and write what "
      "each row and column is into its heading (Soll X [mm]; Run 1 + [um])");
}

/// The headings of readings whose cells are all empty: a template that was not filled in.
std::string empty_readings(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns) {
  std::vector<std::string> found;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const format::ColumnGroup* const known = format::find_column(table.headings[k].name);
    const bool reading = known != nullptr && known->use == format::ColumnUse::kReading;
    if (columns[k].use == SheetColumn::Use::kLeft && columns[k].why == "empty" && reading)
      found.push_back(table.headings[k].text);
  }
  return text::joined(found, ", ");
}

/// One cell as the measurement file writes it.
std::string cell_text(const sheet::Sheet& sheet, const SheetColumn& column, const std::string& cell,
                      std::size_t row) {
  const text::Place place{sheet.file, sheet.line[row]};
  const SheetWishes usual;
  const bool axis = column.use == SheetColumn::Use::kColumn && Guess(usual).is_axis(column.name);
  if (column.words) return cell;
  if (is_label(column.name)) {
    const std::string small = text::in_small_letters(cell);
    if (column.name != columns::kRole) return cell;
    if (std::string role = role_said(small); !role.empty() || small.empty()) return role;
    throw text::InputError(place, cell, format::kRoleRule);
  }
  if (is_missing(cell) && !is_sense(column.name) && !(axis && is_failed_formula(cell))) return "";
  if (cell.empty())
    throw text::InputError(
        place, column.name,
        "the cell of the approach direction is empty; if the direction is not known, as "
        "before the first motion of the axis, write 0; if the value above it applies, give "
        "--fill with the heading of this column");
  if (is_sense(column.name))
    if (const int sense = sense_said(cell); sense != 0) return std::to_string(sense);
  if (const auto number = sheet::plain_number(cell, sheet.decimal_comma)) return *number;
  if (is_sense(column.name))
    throw text::InputError(
        place, cell,
        fmt::format("not an approach direction, for {}: write + or -, forward or backward, "
                    "hin or zurück; + is the direction of increasing positions. If the rows are in the order "
                    "of the measurement, give --leave with the heading of this column, and --directions "
                    "from-order",
                    column.name));
  if (sheet::is_date(cell))
    throw text::InputError(place, cell,
                           fmt::format("a date or a time of day, not a number, for {}; give the cells of "
                                       "this column the number format of the spreadsheet",
                                       column.name));
  if (const auto both = sheet::number_and_unit(cell, sheet.decimal_comma))
    throw text::InputError(place, cell,
                           fmt::format("a number with the unit {}, for {}; write the unit in the heading "
                                       "([{}]), numbers alone in the cells",
                                       both->second, column.name, both->second));
  if (sheet::plain_number(cell, !sheet.decimal_comma))
    throw text::InputError(place, cell,
                           fmt::format("not a number, for {}: {}", column.name, other_decimal_sign(sheet)));
  throw text::InputError(
      place, cell,
      "not a number, for " + column.name +
          (axis ? "; correct the number, or delete the row if it is no measurement"
                : "; write - in a cell without a value, or leave the column out (--leave)"));
}

}  // namespace

ImportTable table_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  ImportTable result{sheet.file, {}, {}};
  const Guess guess(wishes);
  const text::Place heading{sheet.file, sheet.line[table.heading_row]};
  // The same value in every row (--set) is a column too.
  std::vector<SheetColumn> all = columns;
  for (const MappedColumn& constant : wishes.constants)
    all.push_back({SheetColumn::Use::kColumn, constant.name, constant.unit, "as given"});
  const Readings readings(all);
  bool measured = std::any_of(all.begin() + static_cast<std::ptrdiff_t>(columns.size()), all.end(),
                              [&](const SheetColumn& column) { return readings.contain(column); });
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kLeft) continue;
    measured |= column.use == SheetColumn::Use::kDeviation || readings.contain(column);
  }
  refuse_unclear_signs(columns);
  refuse_magnitudes(sheet, table, columns);
  refuse_doubtful(columns);
  refuse_numbers_of_positions(sheet, table, columns, guess);
  refuse_without_units(sheet, table, columns, readings, guess);
  if (const std::string empty = measured ? "" : empty_readings(table, columns); !empty.empty())
    throw text::InputError(
        heading, "",
        fmt::format(
            "the columns of readings are empty ({}): fill in the readings, then import the table again",
            empty));
  if (const std::string runs = measured ? "" : remedy_for_unknown_runs(table); !runs.empty())
    throw text::InputError(
        heading, "",
        fmt::format("no column of the table is a reading{}; --preview shows the meaning of "
                    "each column",
                    runs));
  if (!measured) {
    refuse_positions_in_headings(sheet, table);
    refuse_unreadable(sheet, table, columns, [&](std::size_t k) {
      const SheetColumn column = guess.column(table.headings[k]);
      return column.use == SheetColumn::Use::kDeviation ||
             (!column.name.empty() && format::find_column(column.name) != nullptr && wants_unit(column));
    });
  }
  if (!measured) {
    refuse_side_by_side(sheet, table);
    std::vector<std::string> units;
    for (const SheetColumn& column : columns) units.push_back(column.unit);
    if (const std::string points = points_alone(sheet, table, columns); !points.empty())
      throw text::InputError(heading, "", "no column of the table is a reading: " + points);
    if (const std::string why = no_assignment(sheet, table, units); !why.empty())
      throw text::InputError(
          heading, "",
          fmt::format("no column of the table is a reading: {}; --preview shows the meaning of each column",
                      why));
  }
  if (!measured)
    throw text::InputError(
        heading, "",
        fmt::format("no column of the table is a reading ({}, or a deviation of an axis): assign one, such "
                    "as {}; --preview shows the meaning of each column",
                    format::reading_column_names(), assignments_to_try(sheet, table, columns, guess)));
  for (std::size_t k = 0; k < columns.size(); ++k)
    check_quantity(columns[k], guess, table.headings[k].text, heading);
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto& cells = sheet.rows[row];
    if (sheet::is_blank(cells)) continue;
    result.line.push_back(sheet.line[row]);
  }
  std::map<std::string, std::size_t> made_of;  // column by the name of its values
  const auto twice = [&](std::size_t k, const std::string& name) {
    const auto option = [&](std::size_t one) {
      // A heading that occurs twice is named by the number of its column.
      const auto same =
          std::count_if(table.headings.begin(), table.headings.end(),
                        [&](const sheet::Heading& other) { return other.text == table.headings[one].text; });
      return same > 1 ? fmt::format("--leave {}", std::to_string(one + 1))
                      : fmt::format("--leave \"{}\"", table.headings[one].text);
    };
    throw text::InputError(
        heading, table.headings[k].text,
        fmt::format(
            "this column and the column \"{}\" both have the meaning {}: leave out the one that is no "
            "reading, {} or {}{}",
            table.headings[made_of.at(name)].text, name, option(made_of.at(name)), option(k),
            table.headings[made_of.at(name)].text == table.headings[k].text
                ? "; if they are repeated runs, write the number of the run before each heading (Lauf 1, "
                  "Lauf 2)"
                : ""));
  };
  std::map<std::string, std::size_t> axis_column;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SheetColumn::Use::kColumn) axis_column.emplace(columns[k].name, k);
  const auto mm = [](const std::string& text, const std::string& unit) {
    const format::Unit found = *format::find_unit(unit);
    return *text::parse_number(text) * found.factor;
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kLeft) continue;
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    ImportTable::Column made{
        deviation ? text::in_small_letters(column.name) : column.name, deviation ? "mm" : column.unit, {}};
    const std::string beside = column.to_target ? text::in_small_letters(column.name) : column.name;
    const std::size_t base = deviation && axis_column.contains(beside) ? axis_column[beside] : columns.size();
    const auto still = std::find_if(wishes.constants.begin(), wishes.constants.end(),
                                    [&](const MappedColumn& one) { return one.name == beside; });
    const bool moves = base != columns.size();
    const std::string position_unit = moves                             ? columns[base].unit
                                      : still != wishes.constants.end() ? still->unit
                                                                        : "";
    const double sign = column.turned != column.to_target ? -1 : 1;
    if (column.to_target) made.name = column.name;
    if (deviation && !moves && still == wishes.constants.end())
      refuse_unreadable(sheet, table, columns, [&](std::size_t at) {
        const std::vector<std::string> words = heading_words(table.headings[at].name);
        return guess.column(table.headings[at]).name == beside ||
               std::any_of(words.begin(), words.end(),
                           [](const std::string& word) { return says_target(text::in_small_letters(word)); });
      });
    if (deviation && !moves && still == wishes.constants.end())
      throw text::InputError(
          heading, column.name,
          fmt::format("this axis has no column: state its position, for example {}", set_position(column)));
    if (deviation && is_angle(position_unit)) {
      made.name = angle_of(column.name, heading);
      made.unit = "deg";
      if (!is_angle(column.unit))
        throw text::InputError(heading, table.headings[k].text,
                               "a length, where " + column.name + " is an angle");
    } else if (deviation && is_angle(column.unit)) {
      throw text::InputError(heading, table.headings[k].text,
                             "an angle, where " + column.name + " is a length");
    }
    if (deviation && !column.to_target && !reading_of(column.name))
      throw text::InputError(heading, column.name,
                             "no reading of a measurement file is along this axis; state the axis that it is "
                             "parallel to, such as --deviation \"X=" +
                                 table.headings[k].text + "\"");
    if (!made_of.emplace(made.name, k).second) twice(k, made.name);
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto& cells = sheet.rows[row];
      if (sheet::is_blank(cells)) continue;
      std::string text = cell_text(sheet, column, cells[k], row);
      if (deviation && !text.empty()) {
        const std::string at = moves ? cell_text(sheet, columns[base], cells[base], row)
                                     : constant_cell(*still, sheet.decimal_comma);
        if (at.empty())
          throw text::InputError(
              {sheet.file, sheet.line[row]}, table.headings[base].text,
              fmt::format(
                  "the cell of the position is empty in a row with a deviation; {}; if the row is no "
                  "measurement (a mean, a sum), delete the row; if the deviations are shifted by one row "
                  "against the positions, move their column",
                  remedy_of_empty_position(sheet, table, base)));
        // Nine decimals are below every instrument: adding leaves no tail of binary digits.
        text = text::fixed_text(mm(at, position_unit) + sign * mm(text, column.unit), 9);
      }
      made.cells.push_back(std::move(text));
    }
    if (is_sense(made.name))
      settle_senses(sheet, result.line, table.headings[k].text == made.name, made.cells);
    result.columns.push_back(std::move(made));
  }
  for (const MappedColumn& constant : wishes.constants) {
    if (result.find(constant.name) != nullptr)
      throw text::InputError(heading, constant.name,
                             "the table already has this column: omit --set, or exclude the column of the "
                             "table (--leave HEADING)");
    result.columns.push_back(
        {constant.name, constant.unit,
         std::vector<std::string>(result.line.size(), constant_cell(constant, sheet.decimal_comma))});
  }
  if (wishes.directions_from_order)
    add_directions_from_order(result, [&](const std::string& name) { return guess.is_axis(name); });
  refuse_readings_without_position(result, guess);
  return result;
}

}  // namespace vernier::importer
