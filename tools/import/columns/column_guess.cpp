// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;

const std::string kSenseOfAxis = format::entry_of(format::AxisQuantity::kSense).prefix;

/// Name of a column whose heading names no axis.
std::string other(const sheet::Heading& heading) {
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
                                                            {"richtung", kSenseOfAxis},
                                                            {"direction", kSenseOfAxis},
                                                            {"sense", kSenseOfAxis},
                                                            {"länge", columns::kLength},
                                                            {"laenge", columns::kLength},
                                                            {kSenseOfAxis, kSenseOfAxis},
                                                            {"dir.", kSenseOfAxis},
                                                            {"richtg", kSenseOfAxis},
                                                            {"richtg.", kSenseOfAxis},
                                                            {"richt.", kSenseOfAxis},
                                                            {"sinn", kSenseOfAxis},
                                                            {"ri", kSenseOfAxis},
                                                            {"ri.", kSenseOfAxis},
                                                            {"rtg", kSenseOfAxis},
                                                            {"rtg.", kSenseOfAxis},
                                                            {"fahrtrichtung", kSenseOfAxis},
                                                            {"anfahrrichtung", kSenseOfAxis},
                                                            {"approach", kSenseOfAxis},
                                                            {"direzione", kSenseOfAxis},
                                                            {"corsa", columns::kRun},
                                                            {"ciclo", columns::kRun},
                                                            {"motion", kSenseOfAxis}};
  const auto found = kNames.find(text::in_small_letters(heading.name));
  if (found != kNames.end()) return found->second;
  // "Run #", "Lauf Nr.": the number of the run.
  std::vector<std::string> words;
  for (const std::string& word : heading_words(text::in_small_letters(heading.name)))
    if (!says_counting(word)) words.push_back(word);
  const auto run = words.size() == 1 ? kNames.find(words.front()) : kNames.end();
  return run != kNames.end() && run->second == columns::kRun ? run->second
                                                             : sheet::name_from_words(heading.name);
}

/// True if any word of a heading is in a list of words.
bool any_word(const sheet::Heading& heading, bool (*says)(const std::string&)) {
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return says(text::in_small_letters(word)); });
}

/// A heading that does not state along or about which axis its error is; empty if the heading does.
std::string direction_missing(const sheet::Heading& heading) {
  const std::string unit = heading.unit.empty() ? "" : "[" + heading.unit + "]";
  if (any_word(heading, says_straightness))
    return "straightness along which axis? State the axis along which the error was measured, --deviation "
           "\"Y" +
           unit + "=" + heading.text + "\" or --deviation \"Z" + unit + "=" + heading.text + "\"";
  if (any_word(heading, says_tilt))
    return "a rotation about which axis? State the axis (right-hand rule), for example --column \"ry" + unit +
           "=" + heading.text + "\"";
  return {};
}

}  // namespace

bool is_known_name(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return column != nullptr && (!column->later || column->words);
}
bool is_label(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return column != nullptr && column->words;
}
bool is_sense(const std::string& name) { return name.starts_with(kSenseOfAxis); }
bool is_pure(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return is_sense(name) || (column != nullptr && !column->words && *column->unit == '\0');
}

bool is_temperature(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return !unit.empty() && found && found->dimension == format::Dimension::kTemperature;
}

bool is_angle(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return found && found->dimension == format::Dimension::kAngle;
}

bool wants_unit(const SheetColumn& column) {
  return column.use != SheetColumn::Use::kLeft && !column.words && !is_label(column.name) &&
         !is_pure(column.name);
}

void leave_column(SheetColumn& column, const std::string& why) {
  column.use = SheetColumn::Use::kLeft;
  column.why = why;
}

std::optional<std::string> reading_of(const std::string& axis) {
  if (axis == "X" || axis == "Y" || axis == "Z") return text::in_small_letters(axis);
  return format::angle_about(axis);
}

bool names_correction(const sheet::Heading& heading) {
  bool correction = false;
  for (const std::string& word : heading_words(heading.name)) {
    const std::string small = text::in_small_letters(word);
    if (says_deviation(small) || says_measured(small) || says_state_of_correction(small)) return false;
    correction |= says_correction(small);
  }
  return correction;
}

sheet::Heading heading_of_directions() { return {"direction", "sense", "", ""}; }
sheet::Heading heading_of_runs() { return {columns::kRun, columns::kRun, "", ""}; }
sheet::Heading heading_of_joined(const sheet::Heading& named, const std::string& first,
                                 const std::string& last) {
  sheet::Heading heading = named;
  heading.text = fmt::format("{} to {}", first, last);
  heading.joined = true;
  return heading;
}

bool Guess::is_axis(const std::string& word) const {
  if (!wishes_.axes.empty())
    return std::find(wishes_.axes.begin(), wishes_.axes.end(), word) != wishes_.axes.end();
  if (word.size() == 1) return std::string("XYZABCUVW").find(word) != std::string::npos;
  return word.size() == 2 && (word[0] == 'J' || word[0] == 'A') &&
         std::isdigit(static_cast<unsigned char>(word[1])) != 0;
}

SheetColumn Guess::column(const sheet::Heading& heading) const {
  SheetColumn column{SheetColumn::Use::kColumn, heading.name, heading.unit, "by its heading"};
  if (is_axis(heading.name) || is_known_name(heading.name) || is_motion(heading.name)) return column;
  if (const auto component = component_error(heading)) return *component;
  std::string axis, small_axis;
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
                             : word.starts_with("\u2206") ? word.substr(3)
                                                          : "";
    if (is_axis(tail)) {
      axis = tail;
      deviation = true;
    }
    if (axis.empty() && is_axis(word)) axis = word;
    if (std::find(columns::kPoint.begin(), columns::kPoint.end(), word) != columns::kPoint.end())
      small_axis = word;
  }
  deviation |= sign_said(heading.text, SignPlace::kHeading) != SignSaid::kNothing;
  if (deviation && axis.empty() && is_temperature(heading.unit)) deviation = false;  // "Δ T [K]"
  if (deviation) return {SheetColumn::Use::kDeviation, axis, heading.unit, "by its heading"};
  // "Ist x": the readings of this format have small letters.
  if (axis.empty() && measured && !small_axis.empty()) {
    column.name = small_axis;
    return column;
  }
  if (!axis.empty() && measured) {
    if (const auto reading = reading_of(axis)) {
      column.name = *reading;
    } else {
      column.use = SheetColumn::Use::kLeft;
      column.why = fmt::format(
          "no reading of a measurement file is along {}: state which one this is, --column \"x={}\"", axis,
          heading.text);
    }
    return column;
  }
  if (!axis.empty() && (target || words.size() == 1)) {
    column.name = axis;
    return column;
  }
  if (!axis.empty() && words.size() == 2) {
    sheet::Heading rest = heading;
    rest.name = words[0] == axis ? words[1] : words[0];
    if (other(rest) == kSenseOfAxis) {
      column.name = kSenseOfAxis + axis;
      return column;
    }
  }
  if (std::string missing = direction_missing(heading); !missing.empty())
    return {SheetColumn::Use::kLeft, heading.name, heading.unit, std::move(missing)};
  column.name = other(heading);
  return column;
}

std::optional<SheetColumn> Guess::component_error(const sheet::Heading& heading) const {
  std::string found;
  for (const std::string& word : heading_words(heading.name)) {
    const bool error = word.size() == 3 && word[0] == 'E' &&
                       std::string_view("XYZABC").find(word[1]) != std::string_view::npos &&
                       is_axis(word.substr(2));
    if (error && !found.empty()) return std::nullopt;
    if (error) found = word;
  }
  if (found.empty() || names_correction(heading)) return std::nullopt;
  const std::string direction = found.substr(1, 1), axis = found.substr(2);
  const bool along = std::string_view("XYZ").find(direction) != std::string_view::npos;
  constexpr const char* kWhy = "by its heading (component error of ISO 230-1)";
  if (along || direction == axis)
    return SheetColumn{SheetColumn::Use::kDeviation, direction, heading.unit, kWhy};
  return SheetColumn{SheetColumn::Use::kColumn, *reading_of(direction), heading.unit, kWhy};
}

Guess::Bare Guess::bare(const std::string& name) {
  static const std::set<std::string> kActual = {"ist",      "istwert", "istposition", "istmaß",
                                                "istmass",  "actual",  "act",         "measured",
                                                "gemessen", "laser",   "tracker"};
  Bare found = Bare::kOther;
  for (const std::string& word : heading_words(name)) {
    const std::string small = text::in_small_letters(word);
    if (kActual.contains(small))
      found = Bare::kActual;
    else if (says_display(small) && found != Bare::kActual)
      found = Bare::kDisplay;
    else if (!says_target(small))
      return Bare::kOther;
    else if (found == Bare::kOther)
      found = Bare::kTarget;
  }
  return found;
}

std::optional<std::size_t> column_of_positions(const sheet::SheetTable& table) {
  const SheetWishes usual;
  const Guess guess(usual);
  for (std::size_t k = 0; k < table.headings.size(); ++k)
    if (guess.is_axis(guess.column(table.headings[k]).name) ||
        Guess::bare(table.headings[k].name) == Guess::Bare::kTarget)
      return k;
  return std::nullopt;
}

bool counts_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  constexpr std::size_t kFewest = 3;  // fewer rows agree by chance
  std::size_t count = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const auto value = sheet::number_at(sheet, row, column);
    if (!value || *value != static_cast<double>(++count)) return false;
  }
  return count >= kFewest && table.headings[column].unit.empty() &&
         table.headings[column].unknown_unit.empty();
}

bool numbers_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  constexpr std::size_t kFewest = 3;  // fewer numbers agree by chance
  std::set<double> different;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const auto value = sheet::number_at(sheet, row, column);
    if (!value || sheet::decimals_of(sheet.rows[row][column], sheet.decimal_comma) > 0) return false;
    different.insert(*value);
  }
  return different.size() >= kFewest && *different.begin() == 1 &&
         *different.rbegin() == static_cast<double>(different.size()) &&
         table.headings[column].unit.empty() && table.headings[column].unknown_unit.empty();
}

std::string option_of_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns, const Guess& guess,
                                std::size_t deviation) {
  std::optional<std::size_t> nearest, sized;
  bool numbered = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words || guess.is_axis(column.name)) continue;
    const std::vector<std::string> words = heading_words(table.headings[k].name);
    const bool target = std::any_of(words.begin(), words.end(), [](const std::string& word) {
      return says_target(text::in_small_letters(word));
    });
    const auto unit = column.unit.empty() ? std::nullopt : format::find_unit(column.unit);
    const bool length = unit && (unit->dimension == format::Dimension::kLength || is_angle(column.unit));
    const bool numbers = target && numbers_positions(sheet, table, k);
    numbered |= numbers;
    if (target && !numbers && (!nearest || k < deviation)) nearest = k;
    if (length && k < deviation) sized = k;
  }
  if (!nearest) nearest = sized;
  const std::string axis = axis_to_try(sheet, table);
  if (!nearest && numbered)
    return fmt::format("--column \"{}[mm]=HEADING\", after you wrote a column with the positions", axis);
  if (!nearest) return fmt::format("--set \"{}[mm]=0\"", axis);
  return fmt::format("--column \"{}{}={}\"", axis, columns[*nearest].unit.empty() ? "[mm]" : "",
                     table.headings[*nearest].text);
}

}  // namespace vernier::importer
