// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/sheet_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/tables/column_guess.h"
#include "tools/import/tables/column_values.h"
#include "tools/import/tables/doubled.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
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

void leave(SheetColumn& column, const std::string& why) {
  column.use = SheetColumn::Use::kLeft;
  column.why = why;
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

/// If no heading names an axis and the titles do, a target or an actual position belongs to that axis.
void settle_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 const Guess& guess) {
  std::set<std::string> axes, of_deviations;
  bool read = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kDeviation && guess.is_axis(column.name))
      of_deviations.insert(column.name);
    if (column.use != SheetColumn::Use::kColumn) continue;
    if (guess.is_axis(column.name)) axes.insert(column.name);
    // The heading of a mean may have the letter of a reading.
    if (!names_statistic(table.headings[k]))
      read |= std::find(columns::kPoint.begin(), columns::kPoint.end(), column.name) != columns::kPoint.end();
  }
  // Straightness is a deviation of another axis than the one that moves.
  if (axes.empty()) {
    const std::string titled = axis_of_titles(sheet, table);
    axes = guess.is_axis(titled) ? std::set<std::string>{titled} : of_deviations;
  }
  const std::string axis = axes.size() == 1 ? *axes.begin() : "";
  if (axis.empty() || read) return;
  bool target = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis;
  });
  bool actual = false;
  const auto has = [&](Guess::Bare kind) {
    return std::any_of(table.headings.begin(), table.headings.end(),
                       [&](const sheet::Heading& one) { return Guess::bare(one.name) == kind; });
  };
  // "Anzeige" beside "Laser" is the target.
  const bool shown = !has(Guess::Bare::kTarget) && has(Guess::Bare::kActual);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.why != "by its heading") continue;
    Guess::Bare bare = Guess::bare(table.headings[k].name);
    if (bare == Guess::Bare::kDisplay && shown) bare = Guess::Bare::kTarget;
    if (bare == Guess::Bare::kActual && !actual && reading_of(axis)) {
      column.name = *reading_of(axis);
      actual = true;
    } else if (bare == Guess::Bare::kTarget && !target) {
      column.name = axis;
      target = true;
    }
  }
}

/// Two measured positions along an axis without a target: the position shown by the machine counts as
/// commanded if another instrument measured.
void settle_display(const sheet::SheetTable& table, std::vector<SheetColumn>& columns, const Guess& guess) {
  std::map<std::string, std::size_t> count;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn) ++count[column.name];
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.name.size() != 1 || count[column.name] < 2 || column.why != "by its heading") continue;
    const std::string axis(1, static_cast<char>(std::toupper(static_cast<unsigned char>(column.name[0]))));
    if (axis == column.name || !guess.is_axis(axis) || count[axis] > 0) continue;
    if (text::in_small_letters(table.headings[k].name).find("istposition") == std::string::npos) continue;
    --count[column.name];
    ++count[axis];
    column.name = axis;
  }
}

/// The position that the control shows is the commanded one if the table has another measurement of the axis
/// and no target. Beside a target it is no reading.
void settle_shown_position(const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                           const Guess& guess) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.why != "by its heading") continue;
    std::string axis;
    bool display = false;
    for (const std::string& word : heading_words(table.headings[k].name)) {
      display |= says_display(text::in_small_letters(word));
      if (guess.is_axis(word)) axis = axis.empty() ? word : "more than one";
    }
    const auto unit = format::find_unit(column.unit);
    const bool large = column.unit.empty() || (unit && unit->factor >= 1);  // a gauge shows um
    if (!display || !large || !guess.is_axis(axis)) continue;
    bool target = false, measured = false;
    for (const SheetColumn& other : columns) {
      if (&other == &column || other.use == SheetColumn::Use::kLeft) continue;
      const bool deviation = other.use == SheetColumn::Use::kDeviation;
      target |= !deviation && other.name == axis;
      measured |= deviation ? other.name.empty() || other.name == axis : other.name == reading_of(axis);
    }
    if (measured && target)
      leave(column, fmt::format("the control shows this position; the target is the column {}", axis));
    else if (measured)
      column.name = axis;
  }
}

/// The unit in a heading, or in the row of units, is a fact of the file: an assignment with another unit is a
/// mistake in one of the two.
void refuse_another_unit(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t at,
                         const SheetWishes::Assignment& wish) {
  const sheet::Heading& heading = table.headings[at];
  if (wish.column.unit.empty() || heading.unit.empty() || wish.column.unit == heading.unit) return;
  throw text::InputError(
      wish.place.file.empty() ? text::Place{sheet.file, sheet.line[table.heading_row]} : wish.place,
      heading.text,
      fmt::format("the table states the unit {}, the assignment to {} states {}: omit the unit in the "
                  "assignment, or correct the heading",
                  heading.unit, wish.column.name, wish.column.unit));
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
    if (columns[k].why == "by its heading" && names_statistic(table.headings[k]))
      leave(columns[k], "this column is computed from the readings in the other columns");
}

/// A text about the sign of deviations, and what it states.
struct SignText {
  SignSaid said = SignSaid::kNothing;
  std::size_t line = 0;
  std::string text;

  void add(SignSaid sign, std::size_t at, const std::string& words) {
    const SignSaid both = both_signs(said, sign);
    if (both != said) *this = {both, at, words};
  }
};

/// The cell with a blank behind it if it is only a label ("Vorzeichen:") of the next cell; empty otherwise.
std::string label_of_sign(const std::string& cell) {
  const std::vector<std::string> words = text::words_in(text::in_small_letters(cell), " \t:");
  const bool alone = words.size() == 1 && (words[0].starts_with("vorzeichen") || words[0] == "sign");
  return alone ? cell + " " : "";
}

/// The sign that the file states outside the headings: in titles, remarks, and cells of words in the rows.
SignText sign_of_texts(const sheet::Sheet& sheet, const sheet::SheetTable& table, Travel travel) {
  SignText found;
  const auto look = [&](const std::string& text, std::size_t line) {
    found.add(sign_said(text, SignPlace::kTitle, travel), line, text);
  };
  for (const sheet::Remark& remark : sheet.remarks) look(remark.text, remark.line);
  const std::size_t headings = table.upper_row ? *table.upper_row : table.heading_row;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    if (table.has_headings && row >= headings && row < table.first_data) continue;
    std::string label;
    for (const std::string& cell : sheet.rows[row]) {
      if (cell.size() <= 4 || sheet::plain_number(cell, sheet.decimal_comma)) continue;
      look(label + cell, sheet.line[row]);
      label = label_of_sign(cell);
    }
  }
  // A cover sheet is about all sheets of the workbook; another table states its own sign.
  std::string label;
  for (const sheet::TextElsewhere& other : sheet.elsewhere) {
    if (other.table) continue;
    found.add(sign_said(label + other.text, SignPlace::kTitle, travel), 0,
              fmt::format("sheet {}: {}", other.sheet, label + other.text));
    label = label_of_sign(other.text);
  }
  return found;
}

/// The side of zero of the positions of the axis of a deviation: of its targets, or else of its readings.
Travel travel_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                 const std::vector<SheetColumn>& columns, const SheetColumn& deviation,
                 const std::vector<MappedColumn>& constants) {
  bool above = false, below = false;
  const auto count = [&](std::optional<double> value) {
    above |= value && *value > 0;
    below |= value && *value < 0;
  };
  const std::string positions = deviation.to_target ? *reading_of(deviation.name) : deviation.name;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || columns[k].name != positions) continue;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma))
        count(text::parse_number(*number));
  }
  for (const MappedColumn& constant : constants)
    if (constant.name == positions) count(text::parse_number(constant.constant));
  if (above && below) return Travel::kBothSides;
  return below ? Travel::kNegative : Travel::kPositive;
}

/// A sign that is stated: by the user, in the heading of a deviation, or in another text for all of them.
void settle_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                  std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  std::map<Travel, SignText> of_travel;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kDeviation) continue;
    if (wishes.turned) {
      column.turned = *wishes.turned;
      continue;
    }
    const Travel travel = travel_of(sheet, table, columns, column, wishes.constants);
    if (!of_travel.contains(travel)) of_travel[travel] = sign_of_texts(sheet, table, travel);
    const SignText& texts = of_travel[travel];
    const sheet::Heading& heading = table.headings[k];
    SignText sign;
    sign.add(sign_said(heading.text, SignPlace::kHeading, travel), sheet.line[table.heading_row],
             heading.text);
    if (sign.said == SignSaid::kNothing && names_correction(heading))
      sign.said = SignSaid::kNominalLessActual;  // the titles are about deviations
    else
      sign.add(texts.said, texts.line, texts.text);
    if (sign.said != SignSaid::kNothing && sign.text == texts.text) column.sign_from = texts.text;
    column.turned = sign.said == SignSaid::kNominalLessActual;
    if (sign.said != SignSaid::kUnclear) continue;
    column.sign_place = {sheet.file, sign.line};
    column.sign_text = sign.text;
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
    leave(columns[deviation],
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
    if (deviation && column.unit == "in") {
      const auto along = std::find_if(columns.begin(), columns.end(), [&](const SheetColumn& one) {
        return one.use == SheetColumn::Use::kColumn && one.name == column.name;
      });
      if (along != columns.end() && is_angle(along->unit)) column.unit = "arcsec";  // " beside degrees
    }
    if (deviation && !axes.contains(column.name) && alone_measured.contains(column.name))
      column.to_target = true;
    else if (deviation && !column.name.empty() && !positions.contains(column.name) && reading_of(column.name))
      leave(column, fmt::format("the table has no position of {}: state the position, for example {}",
                                column.name, set_position(column)));
    else if (deviation && column.name.empty())
      leave(column, fmt::format("the axis of this deviation is not known: state the axis, --deviation "
                                "\"X={}\"{}",
                                table.headings[k].text,
                                positions.empty() ? " " + option_of_positions(table, columns, guess, k) +
                                                        " (with the position of X)"
                                                  : ""));
    else if (deviation && !reading_of(column.name))
      leave(column, fmt::format("no reading of a measurement file is along {}: state the axis that it is "
                                "parallel to, --deviation \"X={}\"{}",
                                column.name, table.headings[k].text,
                                positions.contains("X") ? "" : " --set \"X[mm]=0\" (with its position)"));
    else if (deviation && measured.contains(*reading_of(column.name)))
      settle_beside_reading(sheet, table, columns, k, measured);
    else if (column.name == kSensePrefix && moved.size() == 1)
      column.name = format::axis_column(format::AxisQuantity::kSense, *moved.begin());
    else if (column.name == kSensePrefix)
      leave(column, "the axis of this approach direction is not known: state the axis, --column \"dirX=" +
                        table.headings[k].text + "\"");
    else if (column.name == columns::kTime && content == Holds::kDates)
      leave(column, "this column has dates or times of day, not seconds");
    // Dates where a position or a reading should be are refused with their row.
    else if (!column.words && !is_label(column.name) && !is_sense(column.name) &&
             content != Holds::kNumbers && content != Holds::kDates && !holds_units(sheet, table, k) &&
             !holds_other_sign(sheet, table, k))  // such cells are refused with their row
      leave(column, content == Holds::kNothing ? "empty" : "no numbers");
  }
}

/// True if the positions of an axis are angles.
bool rotates(const std::vector<SheetColumn>& columns, const std::string& axis) {
  return std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis && is_angle(one.unit);
  });
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
    leave(one, fmt::format("column {} (\"{}\") is already read as {}; to read this column instead: --leave "
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
  for (const sheet::Heading& heading : table.headings) columns.push_back(guess.column(heading));
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
  settle_axis(sheet, table, columns, guess);
  settle_display(table, columns, guess);
  settle_shown_position(table, columns, guess);
  return columns;
}

std::vector<SheetColumn> columns_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const SheetWishes& wishes) {
  const Guess guess(wishes);
  std::vector<SheetColumn> columns = columns_by_headings(sheet, table, wishes);
  leave_statistics(table, columns);
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
