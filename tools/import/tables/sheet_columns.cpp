// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/sheet_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/tables/column_values.h"
#include "tools/import/tables/sheet_words.h"
#include "tools/sheet/dates.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Words = std::set<std::string>;
namespace columns = format::columns;

const std::string kSensePrefix = format::entry_of(format::AxisQuantity::kSense).prefix;

/// Names of the measurement file that are accepted as they are written. Numbers under a name of a later
/// version of the format may be a user's column.
bool is_known_name(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return column != nullptr && (!column->later || column->words);
}
bool is_label(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return column != nullptr && column->words;
}
bool is_sense(const std::string& name) { return name.starts_with(kSensePrefix); }
bool is_pure(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return is_sense(name) || (column != nullptr && !column->words && *column->unit == '\0');
}

/// Names of columns, to find each in a time that does not depend on their number.
class Readings {
 public:
  explicit Readings(const std::vector<SheetColumn>& columns) {
    for (const SheetColumn& one : columns)
      if (one.use == SheetColumn::Use::kColumn)
        header_.emplace(one.name, format::CsvColumn{one.name, one.unit});
  }
  /// Is a column a reading among these?
  bool contain(const SheetColumn& column) const {
    return format::is_reading({column.name, column.unit},
                              [&](std::string_view name) -> const format::CsvColumn* {
                                const auto found = header_.find(name);
                                return found == header_.end() ? nullptr : &found->second;
                              });
  }

 private:
  std::map<std::string, format::CsvColumn, std::less<>> header_;
};

/// Name of the reading along or about an axis: x, y, z of X, Y, Z; rx, ry, rz of A, B, C; nullopt: other
/// axes.
std::optional<std::string> reading_of(const std::string& axis) {
  if (axis == "X" || axis == "Y" || axis == "Z") return text::in_small_letters(axis);
  return format::angle_about(axis);
}

class Guess {
 public:
  explicit Guess(const SheetWishes& wishes) : wishes_(wishes) {}

  bool is_axis(const std::string& word) const {
    if (!wishes_.axes.empty())
      return std::find(wishes_.axes.begin(), wishes_.axes.end(), word) != wishes_.axes.end();
    if (word.size() == 1) return std::string("XYZABCUVW").find(word) != std::string::npos;
    return word.size() == 2 && (word[0] == 'J' || word[0] == 'A') &&
           std::isdigit(static_cast<unsigned char>(word[1])) != 0;
  }

  /// Taken for an axis by its letter alone: U may be a voltage, A a current.
  bool may_be_no_axis(const std::string& word) const {
    return wishes_.axes.empty() && is_axis(word) && word != "X" && word != "Y" && word != "Z";
  }

  std::optional<format::AxisColumnName> of_axis(const std::string& name) const {
    return format::axis_column_named(name, [&](const std::string& axis) { return is_axis(axis); });
  }
  bool is_motion(const std::string& name) const {
    const auto column = of_axis(name);
    return column && column->quantity != format::AxisQuantity::kPosition;
  }

  SheetColumn column(const sheet::Heading& heading) const {
    SheetColumn column{SheetColumn::Use::kColumn, heading.name, heading.unit, "by its heading"};
    if (is_axis(heading.name) || is_known_name(heading.name) || is_motion(heading.name)) return column;
    std::string axis;
    bool target = false, measured = false, deviation = false;
    const std::vector<std::string> words = heading_words(heading.name);
    for (const std::string& word : words) {
      const std::string small = text::in_small_letters(word);
      target |= says_target(small);
      measured |= says_measured(small);
      deviation |= says_deviation(small);
      // dX, ΔX: a deviation in one word.
      const std::string tail = word.starts_with('d')        ? word.substr(1)
                               : word.starts_with("\u0394") ? word.substr(2)
                                                            : "";
      if (is_axis(tail)) {
        axis = tail;
        deviation = true;
      }
      if (axis.empty() && is_axis(word)) axis = word;
    }
    deviation |= says_nominal_less_actual(heading.text, true) || says_nominal_less_actual(heading.name, true);
    if (deviation) return {SheetColumn::Use::kDeviation, axis, heading.unit, "by its heading"};
    if (!axis.empty() && measured) {
      if (const auto reading = reading_of(axis)) {
        column.name = *reading;
      } else {
        column.use = SheetColumn::Use::kLeft;
        column.why = "no reading of a measurement file is along " + axis +
                     ": state which one this is, --column \"x=" + heading.text + "\"";
      }
      return column;
    }
    if (!axis.empty() && (target || words.size() == 1)) {
      column.name = axis;
      return column;
    }
    column.name = other(heading);
    return column;
  }

  /// Words of a heading that names no axis: "Soll", "Pos", "Istposition".
  enum class Bare { kOther, kTarget, kActual };
  static Bare bare(const std::string& name) {
    static const Words kActual = {"ist", "istwert", "istposition", "actual", "act"};
    Bare found = Bare::kOther;
    for (const std::string& word : heading_words(name)) {
      const std::string small = text::in_small_letters(word);
      if (kActual.contains(small))
        found = Bare::kActual;
      else if (!says_target(small))
        return Bare::kOther;
      else if (found == Bare::kOther)
        found = Bare::kTarget;
    }
    return found;
  }

 private:
  static std::string other(const sheet::Heading& heading) {
    static const std::map<std::string, std::string> kNames = {{"zeit", columns::kTime},
                                                              {"time", columns::kTime},
                                                              {"vorschub", columns::kFeed},
                                                              {"feedrate", columns::kFeed},
                                                              {"feed rate", columns::kFeed},
                                                              {"lauf", columns::kRun},
                                                              {"pass", columns::kRun},
                                                              {"durchgang", columns::kRun},
                                                              {"messreihe", columns::kRun},
                                                              {columns::kRun, columns::kRun},
                                                              {"cycle", columns::kRun},
                                                              {"zyklus", columns::kRun},
                                                              {"unsicherheit", columns::kUncertainty},
                                                              {"uncertainty", columns::kUncertainty},
                                                              {"rolle", columns::kRole},
                                                              {"richtung", kSensePrefix},
                                                              {"direction", kSensePrefix},
                                                              {"sense", kSensePrefix},
                                                              {"länge", columns::kLength},
                                                              {"laenge", columns::kLength},
                                                              {kSensePrefix, kSensePrefix},
                                                              {"dir.", kSensePrefix},
                                                              {"richtg", kSensePrefix},
                                                              {"richtg.", kSensePrefix},
                                                              {"richt.", kSensePrefix},
                                                              {"sinn", kSensePrefix},
                                                              {"fahrtrichtung", kSensePrefix},
                                                              {"anfahrrichtung", kSensePrefix},
                                                              {"approach", kSensePrefix},
                                                              {"motion", kSensePrefix}};
    const auto found = kNames.find(text::in_small_letters(heading.name));
    return found == kNames.end() ? sheet::name_from_words(heading.name) : found->second;
  }

  const SheetWishes& wishes_;
};

/// Index of the column that a user names; npos if none is named.
std::size_t find_heading(const sheet::SheetTable& table, const std::string& words) {
  for (const bool by_text : {true, false})
    for (std::size_t k = 0; k < table.headings.size(); ++k)
      if ((by_text ? table.headings[k].text : table.headings[k].name) == words) return k;
  const auto number = text::parse_number(words);
  if (number && *number >= 1 && *number <= static_cast<double>(table.headings.size()) &&
      *number == std::floor(*number))
    return static_cast<std::size_t>(*number) - 1;
  return std::string::npos;
}

/// "x[mm]" as name and unit.
SheetColumn target_of(const std::string& words, const text::Place& place) {
  SheetColumn column;
  const auto open = words.find('[');
  column.name = text::trimmed(words.substr(0, open));
  if (open != std::string::npos) {
    const std::string unit = words.substr(open);
    if (!unit.ends_with(']') || !sheet::unit_meant(unit))
      throw text::InputError(place, unit, "unknown unit; known are " + format::known_units());
    column.unit = *sheet::unit_meant(unit);
  }
  if (!text::is_name(column.name))
    throw text::InputError(place, column.name, "a column name may have only letters, digits and _");
  return column;
}

std::pair<std::string, std::string> halves(const std::string& words, bool last, const text::Place& place,
                                           const char* form) {
  const auto at = last ? words.rfind('=') : words.find('=');
  std::pair<std::string, std::string> two;
  if (at != std::string::npos)
    two = {text::trimmed(words.substr(0, at)), text::trimmed(words.substr(at + 1))};
  if (two.first.empty() || two.second.empty())
    throw text::InputError(place, words, std::string("not of the form ") + form);
  return two;
}

enum class Holds {
  kNothing,
  kNumbers,
  kWords,
  kDates
};  // words, dates: in most of the cells that are filled

/// Marks of a cell without a value.
bool is_missing(const std::string& cell) {
  static const Words kMarks = {"", "-", "--", "---", "n/a", "na", "#nv", "#n/a", "nan"};
  return kMarks.contains(text::in_small_letters(cell));
}

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

/// A column of words that no known name claims labels its rows.
bool keeps_words(const SheetColumn& column, const Guess& guess) {
  return column.use == SheetColumn::Use::kColumn && !is_known_name(column.name) && !is_sense(column.name) &&
         !guess.is_axis(column.name) && !guess.is_motion(column.name);
}

bool is_linear(const std::string& axis) { return axis == "X" || axis == "Y" || axis == "Z"; }

bool is_angle(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return found && found->dimension == format::Dimension::kAngle;
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
  std::set<std::string> axes;
  bool read = false;
  for (const SheetColumn& column : columns) {
    if (column.use == SheetColumn::Use::kDeviation && guess.is_axis(column.name)) axes.insert(column.name);
    if (column.use != SheetColumn::Use::kColumn) continue;
    if (guess.is_axis(column.name)) axes.insert(column.name);
    read |= std::find(columns::kPoint.begin(), columns::kPoint.end(), column.name) != columns::kPoint.end();
  }
  const std::string titled = axes.empty() ? axis_of_titles(sheet, table) : "";
  const std::string axis = axes.size() == 1 ? *axes.begin() : guess.is_axis(titled) ? titled : "";
  if (axis.empty() || read) return;
  bool target = axes.contains(axis), actual = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.why != "by its heading") continue;
    const Guess::Bare bare = Guess::bare(table.headings[k].name);
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

bool names_statistic(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return says_statistic(text::in_small_letters(word)); });
}

/// The mean or the spread of the readings in the columns beside it is no further reading.
void leave_statistics(const sheet::SheetTable& table, std::vector<SheetColumn>& columns) {
  const Readings readings(columns);
  bool reading = false;
  for (std::size_t k = 0; k < columns.size(); ++k)
    reading |= !names_statistic(table.headings[k]) &&
               (columns[k].use == SheetColumn::Use::kDeviation || readings.contain(columns[k]));
  for (std::size_t k = 0; reading && k < columns.size(); ++k)
    if (columns[k].why == "by its heading" && names_statistic(table.headings[k]))
      leave(columns[k], "computed from the readings beside it");
}

/// A correction cancels the deviation: it is nominal - actual (JCGM 200:2012, 2.53). "Abweichung nach
/// Korrektur" is a deviation, and so is a column that states its formula.
bool names_correction(const sheet::Heading& heading) {
  bool correction = false;
  for (const std::string& word : heading_words(heading.name)) {
    const std::string small = text::in_small_letters(word);
    if (says_deviation(small) || says_measured(small) || says_state_of_correction(small)) return false;
    correction |= says_correction(small);
  }
  return correction;
}

/// A sign that is stated: in the heading of a deviation, or in a title for all of them.
void settle_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                  std::vector<SheetColumn>& columns) {
  const std::vector<std::string> titles = title_cells(sheet, table);
  const bool all = std::any_of(titles.begin(), titles.end(), [](const std::string& title) {
    return says_nominal_less_actual(title, false);
  });
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SheetColumn::Use::kDeviation)
      columns[k].turned = all || says_nominal_less_actual(table.headings[k].text, true) ||
                          says_nominal_less_actual(table.headings[k].name, true) ||
                          names_correction(table.headings[k]);
}

/// Deviations and directions without an axis belong to the only axis; columns that remain open are omitted
/// and reported.
void settle(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
            const Guess& guess) {
  std::set<std::string> axes, measured;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn)
      (guess.is_axis(column.name) ? axes : measured).insert(column.name);
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
    else if (deviation && (column.name.empty() || !axes.contains(column.name)))
      leave(column, "the axis of this deviation is not known: state the axis, --deviation \"X=" +
                        table.headings[k].text + "\"");
    else if (deviation && !reading_of(column.name))
      leave(column, "no reading of a measurement file is along " + column.name +
                        ": state the axis that it is parallel to, --deviation \"X=" + table.headings[k].text +
                        "\"");
    else if (deviation && measured.contains(*reading_of(column.name)))
      leave(column, "the measured position is there as " + *reading_of(column.name));
    else if (column.name == kSensePrefix && moved.size() == 1)
      column.name = format::axis_column(format::AxisQuantity::kSense, *moved.begin());
    else if (column.name == kSensePrefix)
      leave(column, "the axis of this approach direction is not known: state the axis, --column \"dirX=" +
                        table.headings[k].text + "\"");
    else if (column.name == columns::kTime && content == Holds::kDates)
      leave(column, "dates or times of day, no seconds");
    // Dates where a position or a reading should be are refused with their row.
    else if (!column.words && !is_label(column.name) && !is_sense(column.name) &&
             content != Holds::kNumbers && content != Holds::kDates && !holds_units(sheet, table, k))
      leave(column, content == Holds::kNothing ? "empty" : "no numbers");
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
    leave(one, "column " + std::to_string(first->second + 1) + " (\"" + table.headings[first->second].text +
                   "\") is " + column.name + " already; to read this one: --leave " +
                   std::to_string(first->second + 1) + ", or another name: --column \"NAME[unit]=" +
                   std::to_string((&one - columns.data()) + 1) + "\"");
  }
}

/// Suggested unit for a deviation without one: of a rotary axis arcsec.
std::string unit_of_deviation(const std::vector<SheetColumn>& columns, const std::string& axis) {
  const bool rotary = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis &&
           (one.unit.empty() ? !is_linear(axis) : is_angle(one.unit));
  });
  return rotary ? "arcsec" : "um";
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

bool wants_unit(const SheetColumn& column) {
  return column.use != SheetColumn::Use::kLeft && !column.words && !is_label(column.name) &&
         !is_pure(column.name);
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
  throw text::InputError(place, heading,
                         fmt::format("[{}] is no unit of {}{}, which needs {}", column.unit,
                                     column.use == SheetColumn::Use::kDeviation ? "a deviation of " : "",
                                     column.name, pure ? "a pure number" : "a unit like " + needs));
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

/// Does a heading only count or name its rows?
bool names_counting(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(heading.name);
  return !words.empty() && std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return says_counting(text::in_small_letters(word));
  });
}

/// Assignments that read a table in which nothing was recognised as measured, with its own headings.
std::string assignments_to_try(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns,
                               const Guess& guess) {
  const auto axis = std::find_if(columns.begin(), columns.end(), [&](const SheetColumn& column) {
    return column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name);
  });
  std::string position, reading, unit;
  bool actual = false, correction = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words || guess.is_axis(column.name) ||
        guess.is_motion(column.name) || is_sense(column.name) || is_known_name(column.name) ||
        names_counting(table.headings[k]))
      continue;
    const Guess::Bare bare = Guess::bare(table.headings[k].name);
    if (bare == Guess::Bare::kTarget && axis == columns.end() && position.empty()) {
      position =
          fmt::format("--column \"{}={}\" ", column.unit.empty() ? "X[mm]" : "X", table.headings[k].text);
    } else if (reading.empty() || (bare == Guess::Bare::kActual && !actual)) {
      reading = table.headings[k].text;
      unit = column.unit;
      actual = bare == Guess::Bare::kActual;
      correction = names_correction(table.headings[k]);
    }
  }
  const std::string name = axis == columns.end() ? "X" : axis->name;
  if (reading.empty()) reading = "HEADING";
  if (correction)
    return fmt::format("{}--deviation \"{}{}={}\" (a correction is nominal - actual: its sign is reversed)",
                       position, name, unit.empty() ? "[um]" : "", reading);
  return fmt::format(
      "{}--column \"{}{}={}\" for a measured position, or {}--deviation \"{}{}={}\" for a deviation",
      position, reading_of(name).value_or("x"),
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[mm]" : "[deg]") : "", reading,
      position, name,
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[um]" : "[arcsec]") : "", reading);
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
  if (column.words) return cell;
  if (is_label(column.name)) {
    const std::string small = text::in_small_letters(cell);
    if (column.name != columns::kRole) return cell;
    if (small == "kontrolle" || small == "prüfen") return format::kCheckRole;
    if (format::is_role(small) || small.empty()) return small;
    throw text::InputError(place, cell, format::kRoleRule);
  }
  if (is_missing(cell) && !is_sense(column.name)) return "";
  if (cell.empty())
    throw text::InputError(place, column.name,
                           "the cell of the approach direction is empty; if the value above it applies, give "
                           "--fill with the heading of this column");
  if (is_sense(column.name))
    if (const int sense = sense_said(cell); sense != 0) return std::to_string(sense);
  if (const auto number = sheet::plain_number(cell, sheet.decimal_comma)) return *number;
  if (sheet::is_date(cell))
    throw text::InputError(place, cell,
                           "a date or a time of day, not a number, for " + column.name +
                               "; give the cells of this column the number format of the spreadsheet");
  if (const auto both = sheet::number_and_unit(cell, sheet.decimal_comma))
    throw text::InputError(place, cell,
                           fmt::format("a number with the unit {}, for {}; write the unit in the heading "
                                       "([{}]), numbers alone in the cells",
                                       both->second, column.name, both->second));
  const bool other_sign = sheet::plain_number(cell, !sheet.decimal_comma).has_value();
  throw text::InputError(
      place, cell,
      "not a number, for " + column.name +
          (other_sign
               ? std::string("; a decimal ") + (sheet.decimal_comma ? "point" : "comma") +
                     "? (give --decimal point or --decimal comma)"
               : std::string("; write - in a cell without a value, or leave the column out (--leave)")));
}

}  // namespace

void assign_column(SheetWishes& wishes, const sheet::SheetTable& table, const std::string& words) {
  // A heading may hold the sign itself: the split that makes a heading of one side is the one that was meant.
  for (const bool last : {false, true}) {
    const auto [left, right] = halves(words, last, {}, "name[unit]=HEADING");
    if (find_heading(table, right) != std::string::npos && text::is_name(left.substr(0, left.find('[')))) {
      wishes.assignments.push_back({right, target_of(left, {}), {}});
      return;
    }
    if (find_heading(table, left) != std::string::npos) {
      wishes.assignments.push_back({left, target_of(right, {}), {}});
      return;
    }
  }
  std::string known;
  for (const sheet::Heading& heading : table.headings) known += (known.empty() ? "" : ", ") + heading.text;
  throw text::InputError("--column \"" + words + "\": the sheet has no such heading; its headings are " +
                         known);
}

void assign_deviation(SheetWishes& wishes, const std::string& words, const text::Place& place) {
  const auto [left, right] = halves(words, false, place, "AXIS[unit]=HEADING");
  SheetColumn column = target_of(left, place);
  column.use = SheetColumn::Use::kDeviation;
  wishes.assignments.push_back({right, column, place});
}

void read_sheet_profile(SheetWishes& wishes, const std::string& text, const std::string& file) {
  std::size_t number = 0;
  for (const std::string& raw : text::parts_of(text, '\n')) {
    const text::Place place{file, ++number};
    const std::string line = text::trimmed(raw);
    if (line.empty() || line.front() == '#') continue;
    const std::string key = line.substr(0, line.find(' '));
    const std::string rest = text::trimmed(line.substr(key.size()));
    if (key == "column" || key == "deviation") {
      const auto [heading, target] = halves(rest, true, place, "HEADING = name[unit]");
      SheetColumn column = target_of(target, place);
      if (key == "deviation") column.use = SheetColumn::Use::kDeviation;
      wishes.assignments.push_back({heading, column, place});
    } else if (key == "leave") {
      SheetColumn column;
      column.use = SheetColumn::Use::kLeft;
      wishes.assignments.push_back({rest, column, place});
    } else if (key == "fill") {
      wishes.fill.push_back(rest);
    } else if (key == "set") {
      ColumnMap map;
      add_constant(map, rest, place);
      wishes.constants.push_back(map.columns.front());
    } else {
      const auto [name, value] = halves(line, false, place, "STATEMENT = VALUE");
      const auto skip = text::parse_count(value);
      if (name == "separator")
        wishes.format.separator = separator_of(value, place);
      else if (name == "decimal" && (value == "comma" || value == "point"))
        wishes.format.decimal_comma = value == "comma";
      else if (name == "skip" && skip)
        wishes.format.skip = *skip;
      else if (name == "table" && skip)
        wishes.format.table = *skip;
      else if (name == "sheet")
        wishes.format.sheet = value;
      else if (name == "comment")
        wishes.format.comment = value == "none" ? "" : value;
      else if (name == "unit" && sheet::unit_meant(value))
        wishes.unit = *sheet::unit_meant(value);
      else
        throw text::InputError(place, name,
                               "unknown statement; known statements are column, deviation, leave, fill, set, "
                               "separator, decimal, skip, table, sheet, comment, unit");
    }
  }
}

std::string sheet_profile(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  std::string text =
      "# How tables like " + sheet.file + " are read: vernier import table FILE --profile THIS -o MEAS\n";
  if (sheet.workbook && !wishes.format.sheet.empty()) text += "sheet = " + wishes.format.sheet + "\n";
  if (!sheet.workbook)
    text += std::string("separator = ") +
            (sheet.separator == ' ' ? "space" : sheet::separator_word(sheet.separator)) + "\n";
  if (sheet.decimal_known)
    text += std::string("decimal = ") + (sheet.decimal_comma ? "comma" : "point") + "\n";
  if (wishes.format.table) text += "table = " + std::to_string(*wishes.format.table) + "\n";
  if (wishes.format.skip > 0) text += "skip = " + std::to_string(wishes.format.skip) + "\n";
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    const std::string& heading = table.headings[k].text;
    if (column.by_values)
      text += "# " + heading + ": position or deviation, by the values of each file\n";
    else if (column.use == SheetColumn::Use::kLeft)
      text += "leave " + heading + "\n";
    else
      text += (column.use == SheetColumn::Use::kDeviation ? "deviation " : "column ") + heading + " = " +
              format::heading(column.name, column.unit) + "\n";
  }
  for (const std::string& heading : wishes.fill) text += "fill " + heading + "\n";
  for (const MappedColumn& constant : wishes.constants)
    text += "set " + format::heading(constant.name, constant.unit) + " = " + constant.constant + "\n";
  return text;
}

std::vector<SheetColumn> columns_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
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
  leave_statistics(table, columns);
  settle_by_values(sheet, table, columns);
  settle(sheet, table, columns, guess);
  if (!wishes.one_motion) refuse_tables_side_by_side(sheet, table, columns);
  settle_signs(sheet, table, columns);
  keep_names_apart(table, columns);
  for (SheetColumn& column : columns) {
    if (!column.unit.empty() || wishes.unit.empty() || !wants_unit(column)) continue;
    // A unit for all headings without one is for lengths or angles, not for temperatures and loads.
    const std::string& name = column.name;
    const bool length = guess.is_axis(name) || column.use == SheetColumn::Use::kDeviation ||
                        (name.size() <= 2 && name != columns::kTime) || name == columns::kLength;
    if (length) column.unit = wishes.unit;
  }
  return columns;
}

ImportTable table_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  ImportTable result{sheet.file, {}, {}};
  const Guess guess(wishes);
  const text::Place heading{sheet.file, sheet.line[table.heading_row]};
  std::string without;
  Words units;  // suggested for the columns without one
  // The same value in every row (--set) is a column too.
  std::vector<SheetColumn> all = columns;
  for (const MappedColumn& constant : wishes.constants)
    all.push_back({SheetColumn::Use::kColumn, constant.name, constant.unit, "as given"});
  const Readings readings(all);
  bool measured = std::any_of(all.begin() + static_cast<std::ptrdiff_t>(columns.size()), all.end(),
                              [&](const SheetColumn& column) { return readings.contain(column); });
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    const bool geometry = guess.is_axis(column.name) ||
                          ((is_known_name(column.name) || readings.contain(column)) && wants_unit(column));
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    if (wants_unit(column) && column.unit.empty() && (deviation || geometry)) {
      const std::string unit =
          deviation ? unit_of_deviation(columns, column.name) : unit_to_say(column.name, columns);
      if (const std::string& unknown = table.headings[k].unknown_unit; !unknown.empty())
        throw text::InputError(heading, table.headings[k].text,
                               "[" + unknown + "] is no known unit; known are " + format::known_units() +
                                   "; convert the values to one of these units, and correct the heading");
      units.insert(unit);
      without += fmt::format(" {} \"{}[{}]={}\"", deviation ? "--deviation" : "--column", column.name, unit,
                             table.headings[k].text);
    }
    if (column.use == SheetColumn::Use::kLeft) continue;
    measured |= column.use == SheetColumn::Use::kDeviation || readings.contain(column);
  }
  if (!without.empty())
    throw text::InputError(heading, "",
                           "no unit: give it for " +
                               (units.size() == 1 ? "all (--unit " + *units.begin() + ") or for " : "") +
                               "each, such as" + without);
  if (const std::string empty = measured ? "" : empty_readings(table, columns); !empty.empty())
    throw text::InputError(heading, "",
                           "the columns of readings are empty (" + empty +
                               "): fill in the readings, then import the table again");
  if (!measured)
    throw text::InputError(heading, "",
                           "nothing measured among the columns (" + format::reading_column_names() +
                               ", or a deviation of an axis): assign one, such as " +
                               assignments_to_try(table, columns, guess) +
                               "; --preview shows what was understood");
  for (std::size_t k = 0; k < columns.size(); ++k)
    check_quantity(columns[k], guess, table.headings[k].text, heading);
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto& cells = sheet.rows[row];
    if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); }))
      continue;
    result.line.push_back(sheet.line[row]);
  }
  const auto twice = [&](std::size_t k, const std::string& name) {
    throw text::InputError(heading, table.headings[k].text,
                           "this would be " + name +
                               " a second time; leave one of the two columns out, such as "
                               "--leave " +
                               std::to_string(k + 1));
  };
  std::set<std::string> names;
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
    const double sign = column.turned != column.to_target ? -1 : 1;
    if (column.to_target) made.name = column.name;
    if (deviation && base == columns.size())
      throw text::InputError(heading, column.name, "this axis has no column");
    if (deviation && is_angle(columns[base].unit)) {
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
    if (!names.insert(made.name).second) twice(k, made.name);
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto& cells = sheet.rows[row];
      if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); }))
        continue;
      std::string text = cell_text(sheet, column, cells[k], row);
      if (deviation && !text.empty()) {
        const std::string at = cell_text(sheet, columns[base], cells[base], row);
        if (at.empty())
          throw text::InputError({sheet.file, sheet.line[row]}, column.name,
                                 "a deviation without its position: the cell of \"" +
                                     table.headings[base].text +
                                     "\" is empty; if the value above it applies, give --fill \"" +
                                     table.headings[base].text + "\"");
        // Nine decimals are below every instrument: adding leaves no tail of binary digits.
        text = text::fixed_text(mm(at, columns[base].unit) + sign * mm(text, column.unit), 9);
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
  return result;
}

}  // namespace vernier::importer
