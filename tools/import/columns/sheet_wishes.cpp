// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/sheet_wishes.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

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

}  // namespace

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

void refuse_heading(const sheet::SheetTable& table, const std::string& option, const std::string& words) {
  std::string known;
  for (const sheet::Heading& heading : table.headings) known += (known.empty() ? "" : ", ") + heading.text;
  throw text::InputError(fmt::format(
      "{} \"{}\": the sheet has no column with this heading; its headings are {}", option, words, known));
}

void assign_column(SheetWishes& wishes, const sheet::SheetTable& table, const std::string& words,
                   const std::string& option) {
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
  refuse_heading(table, option, words);
}

namespace {

/// A size without a heading is the largest plausible deviation. False: `words` is no size.
bool state_plausible(SheetWishes& wishes, const std::string& words, const text::Place& place) {
  if (words.find('=') != std::string::npos) return false;
  const auto size = sheet::number_and_unit(words, words.find(',') != std::string::npos);
  const auto unit = size ? format::find_unit(size->second) : std::nullopt;
  const auto value = size ? text::parse_number(size->first) : std::nullopt;
  const bool length = unit && unit->dimension == format::Dimension::kLength;
  if (!value || !unit || (!length && unit->dimension != format::Dimension::kAngle)) return false;
  if (!(*value > 0))
    throw text::InputError(place, words, "the largest plausible deviation must be larger than 0");
  (length ? wishes.plausible.mm : wishes.plausible.deg) = *value * unit->factor;
  return true;
}

}  // namespace

void assign_deviation(SheetWishes& wishes, const std::string& words, const text::Place& place) {
  if (state_plausible(wishes, words, place)) return;
  const auto [left, right] = halves(words, false, place, "AXIS[unit]=HEADING, or a limit such as 20mm");
  SheetColumn column = target_of(left, place);
  column.use = SheetColumn::Use::kDeviation;
  wishes.assignments.push_back({right, column, place});
}

bool turned_of(const std::string& words, const text::Place& place) {
  if (words != "nominal-actual" && words != "actual-nominal")
    throw text::InputError(place, words, "the sign of deviations is actual-nominal or nominal-actual");
  return words == "nominal-actual";
}

void read_sheet_profile(SheetWishes& wishes, const std::string& text, const std::string& file) {
  std::size_t number = 0;
  for (const std::string& raw : text::parts_of(text, '\n')) {
    const text::Place place{file, ++number};
    const std::string line = text::trimmed(raw);
    if (line.empty() || line.front() == '#') continue;
    const std::string key = line.substr(0, line.find(' '));
    const std::string rest = text::trimmed(line.substr(key.size()));
    if (key == "deviation" && state_plausible(wishes, rest, place)) continue;
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
      else if (name == "sign")
        wishes.turned = turned_of(value, place);
      else if (name == "directions" && value == kFromOrder)
        wishes.directions_from_order = true;
      else if (name == "unit" && sheet::unit_meant(value))
        wishes.unit = *sheet::unit_meant(value);
      else
        throw text::InputError(
            place, name,
            "this line of the profile has an unknown keyword; known keywords are column, deviation, leave, "
            "fill, set, separator, decimal, skip, table, sheet, comment, unit, sign, directions");
    }
  }
}

std::string sheet_profile(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  std::string text = fmt::format(
      "# How tables like {} are read: vernier import table FILE --profile THIS -o MEAS\n", sheet.file);
  if (sheet.workbook && !wishes.format.sheet.empty()) text += "sheet = " + wishes.format.sheet + "\n";
  if (!sheet.workbook)
    text += std::string("separator = ") +
            (sheet.separator == ' ' ? "space" : sheet::separator_word(sheet.separator)) + "\n";
  if (sheet.decimal_known)
    text += std::string("decimal = ") + (sheet.decimal_comma ? "comma" : "point") + "\n";
  if (wishes.format.table) text += "table = " + std::to_string(*wishes.format.table) + "\n";
  if (wishes.format.skip > 0) text += "skip = " + std::to_string(wishes.format.skip) + "\n";
  if (wishes.turned)
    text += std::string("sign = ") + (*wishes.turned ? "nominal-actual" : "actual-nominal") + "\n";
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    // The readings of runs side by side have a name for any number of runs.
    const std::string& heading = table.headings[k].joined ? table.headings[k].name : table.headings[k].text;
    if (column.by_values)
      text += fmt::format("# {}: position or deviation, by the values of each file\n", heading);
    else if (column.use == SheetColumn::Use::kLeft)
      text += "leave " + heading + "\n";
    else
      text += (column.use == SheetColumn::Use::kDeviation ? "deviation " : "column ") + heading + " = " +
              format::heading(column.name, column.unit) + "\n";
  }
  if (wishes.directions_from_order) text += fmt::format("directions = {}\n", kFromOrder);
  if (wishes.plausible.mm) text += fmt::format("deviation {}mm\n", *wishes.plausible.mm);
  if (wishes.plausible.deg) text += fmt::format("deviation {}deg\n", *wishes.plausible.deg);
  for (const std::string& heading : wishes.fill) text += "fill " + heading + "\n";
  for (const MappedColumn& constant : wishes.constants)
    if (!constant.of_title)
      text += "set " + format::heading(constant.name, constant.unit) + " = " + constant.constant + "\n";
  return text;
}

}  // namespace vernier::importer
