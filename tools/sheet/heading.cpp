// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/heading.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

#include "tools/format/units.h"
#include "tools/sheet/dates.h"
#include "tools/sheet/sheet_number.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

/// Words for units in the languages of shop floors, in small letters, after the signs are spelled out.
constexpr std::array<std::pair<std::string_view, std::string_view>, 68> kUnitWords = {{
    {"millimeter", "mm"},
    {"millimetre", "mm"},
    {"millimeters", "mm"},
    {"millimetres", "mm"},
    {"micron", "um"},
    {"microns", "um"},
    {"micrometer", "um"},
    {"micrometers", "um"},
    {"micrometre", "um"},
    {"micrometres", "um"},
    {"mikrometer", "um"},
    {"mikron", "um"},
    {"my", "um"},
    {"meter", "m"},
    {"metre", "m"},
    {"inch", "in"},
    {"inches", "in"},
    {"zoll", "in"},
    {"\"", "in"},
    {"mil", "thou"},
    {"mils", "thou"},
    {"thousandths", "thou"},
    {"milliradian", "mrad"},
    {"milliradians", "mrad"},
    {"microradian", "urad"},
    {"microradians", "urad"},
    {"mikrorad", "urad"},
    {"mikroradiant", "urad"},
    {"microinch", "uin"},
    {"microinches", "uin"},
    {"uinch", "uin"},
    {"arc min", "arcmin"},
    {"winkelminuten", "arcmin"},
    {"degree", "deg"},
    {"degrees", "deg"},
    {"grad", "deg"},
    {"radian", "rad"},
    {"radians", "rad"},
    {"arc sec", "arcsec"},
    {"arcseconds", "arcsec"},
    {"arcsecond", "arcsec"},
    {"winkelsekunden", "arcsec"},
    {"as", "arcsec"},
    {"celsius", "degC"},
    {"deg c", "degC"},
    {"grad c", "degC"},
    {"grad celsius", "degC"},
    {"c", "degC"},
    {"kelvin", "K"},
    {"sec", "s"},
    {"second", "s"},
    {"seconds", "s"},
    {"sek", "s"},
    {"sekunden", "s"},
    {"msec", "ms"},
    {"minutes", "min"},
    {"minuten", "min"},
    {"mm/sec", "mm/s"},
    {"mm/minute", "mm/min"},
    {"mmpm", "mm/min"},
    {"u/min", "rpm"},
    {"1/min", "rpm"},
    {"min-1", "rpm"},
    {"percent", "%"},
    {"prozent", "%"},
    {"ampere", "A"},
    {"ppm", "um/m"},
    {"volt", "V"},
}};

std::string without_brackets(std::string text) {
  text = text::trimmed(text);
  const std::string open = "[(<{", close = "])>}";
  if (text.size() >= 2 && open.find(text.front()) != std::string::npos &&
      open.find(text.front()) == close.find(text.back()))
    return text::trimmed(text.substr(1, text.size() - 2));
  return text;
}

/// The unit that is a decimal part of a millimetre or an inch, as dial gauges have it: "1/100 mm", "0,01 mm",
/// "Hundertstel", "Teilstriche 0,01 mm"; "tenths" are 0.0001 inch. nullopt for other texts.
std::optional<std::string> decimal_part(std::string_view words) {
  std::string text;
  for (const char c : text::in_small_letters(words))
    if (c != ' ' && c != '\t') text += c == ',' ? '.' : c;
  const auto strip = [&](std::string_view word, bool front) {
    if (text.size() <= word.size() || !(front ? text.starts_with(word) : text.ends_with(word))) return;
    text.erase(front ? 0 : text.size() - word.size(), word.size());
  };
  for (const std::string_view word : {"teilstriche", "teilstrich", "skalenteile", "skalenteil", "skt.", "skt",
                                      "divisions", "division", "div.", "div", "of", "a", "=", ":"}) {
    strip(word, true);
    strip(word, false);
  }
  for (const std::string_view word : {"/", "per", "je", "pro"}) strip(word, false);
  if (text.starts_with('.')) text.insert(0, "0");
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kParts = {{
      {"0.1", "0.1"},
      {"1/10", "0.1"},
      {"0.01", "0.01"},
      {"1/100", "0.01"},
      {"0.001", "0.001"},
      {"1/1000", "0.001"},
      {"0.0001", "0.0001"},
      {"1/10000", "0.0001"},
  }};
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kOf = {{
      {"mm", "mm"},
      {"millimeter", "mm"},
      {"millimetre", "mm"},
      {"ofmm", "mm"},
      {"in", "in"},
      {"inch", "in"},
      {"zoll", "in"},
      {"\"", "in"},
      {"in.", "in"},
  }};
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kWords = {{
      {"zehntel", "0.1mm"},
      {"hundertstel", "0.01mm"},
      {"tausendstel", "0.001mm"},
      {"zehntelmm", "0.1mm"},
      {"hundertstelmm", "0.01mm"},
      {"tausendstelmm", "0.001mm"},
      {"hundredthsofmm", "0.01mm"},
      {"hundredthsofamm", "0.01mm"},
      {"thousandthsofmm", "0.001mm"},
      {"thousandthsofamm", "0.001mm"},
      {"tenths", "0.0001in"},
      {"tenth", "0.0001in"},
  }};
  std::string unit;
  for (const auto& [word, meant] : kWords)
    if (text == word) unit = meant;
  for (const auto& [part, size] : kParts)
    for (const auto& [of, whole] : kOf)
      if (text.size() == part.size() + of.size() && text.starts_with(part) && text.ends_with(of))
        unit = std::string(size) + std::string(whole);
  if (unit == "0.001mm") return "um";
  if (unit == "0.001in") return "thou";
  return unit.empty() || !format::find_unit(unit) ? std::nullopt : std::optional(unit);
}

/// "Zehntel um", "1/10um", "10^-3 mm": a factor and a unit, if the formats have the unit that they make.
std::optional<std::string> factor_and_unit(std::string_view words) {
  const std::size_t digit = words.find_last_of("0123456789");
  for (const std::size_t at : {words.rfind(' '), words.rfind('-'), digit}) {
    if (at == std::string_view::npos || at == 0 || at + 1 >= words.size()) continue;
    const std::string_view rest = words.substr(at + 1);
    const auto factor = factor_at_end(words.substr(0, at + (at == digit ? 1 : 0)));
    if (!factor || factor->begin != 0 || rest.find_first_of("0123456789") != std::string_view::npos) continue;
    if (const auto unit = unit_meant(rest)) return unit_times(factor->value, *unit);
  }
  return std::nullopt;
}

/// A factor before the unit, at the end of the name, or behind the unit belongs to the unit: "1/100 [mm]",
/// "Zehntel um", "[mm] x1000". If the formats do not have such a unit, the unit of the heading is unknown.
void take_factor(Heading& heading, std::string_view behind, bool bare = false) {
  const auto before = factor_at_end(heading.name, bare);
  const auto after = before ? std::nullopt : factor_behind(behind);
  if (heading.unit.empty() || (!before && !after)) return;
  const auto unit = unit_times(before ? before->value : after->value, heading.unit);
  if (!unit)
    heading.unknown_unit = before ? text::trimmed(heading.name.substr(before->begin) + " " + heading.unit)
                                  : heading.unit + " " + text::trimmed(behind);
  heading.unit = unit ? *unit : "";
  if (before) heading.name = text::trimmed(heading.name.substr(0, before->begin));
  for (const std::string_view end : {" in", "(", "["})
    if (heading.name.ends_with(end))
      heading.name = text::trimmed(heading.name.substr(0, heading.name.size() - end.size()));
  if (heading.name.empty()) heading.name = heading.text;
}

/// "Abweichung mm x 100", "Abweichung in mm/100": the unit and a factor behind it, without brackets.
bool factor_behind_a_word(Heading& heading) {
  const std::string& text = heading.text;
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (text[at - 1] != ' ') continue;
    for (std::size_t end = at + 1; end < text.size() && text[end - 1] != ' '; ++end) {
      const bool parts = text[end] == ' ' || text[end] == '/' || text[end] == '*';
      if (!parts || !factor_behind(text.substr(end))) continue;
      const auto unit = unit_meant(text.substr(at, end - at));
      if (!unit || end - at < 2 || text.compare(at, end - at, "in") == 0) continue;
      heading.unit = *unit;
      heading.name = text::trimmed(text.substr(0, at));
      take_factor(heading, text.substr(end));
      return true;
    }
  }
  return false;
}

bool is_numeric(const std::string& cell, const Sheet& sheet) {
  return plain_number(cell, sheet.decimal_comma).has_value();
}

/// A row that contains only units, at least two of them (or all of a narrow table).
bool is_units(const std::vector<std::string>& row) {
  std::size_t units = 0;
  for (const std::string& cell : row) {
    if (cell.empty() || cell == "-" || cell == "[-]") continue;
    if (!unit_meant(cell)) return false;
    ++units;
  }
  return units >= std::min<std::size_t>(2, row.size());
}

std::size_t filled_cells(const std::vector<std::string>& row) {
  return static_cast<std::size_t>(
      std::count_if(row.begin(), row.end(), [](const std::string& cell) { return !cell.empty(); }));
}

/// Cells of a line that also apply to the empty cells at their right: merged cells of a workbook.
std::vector<std::string> spread_to_the_right(const std::vector<std::string>& upper,
                                             const std::vector<std::string>& lower) {
  std::vector<std::string> spread = upper;
  for (std::size_t k = 1; k < spread.size(); ++k)
    if (spread[k].empty() && !lower[k].empty()) spread[k] = spread[k - 1];
  return spread;
}

/// True if the line above belongs to this line of headings. Conditions: this line is not complete (an empty
/// cell, a unit alone, or the same text twice), and the two lines together are.
bool is_second_line(const Sheet& sheet, std::size_t row) {
  const std::vector<std::string>& lower = sheet.rows[row];
  const std::vector<std::string>& upper = sheet.rows[row - 1];
  if (filled_cells(upper) < 2) return false;
  const std::vector<std::string> spread = spread_to_the_right(upper, lower);
  std::set<std::string> seen;
  std::set<std::pair<std::string, std::string>> pairs;
  bool wanting = false;
  for (std::size_t k = 0; k < lower.size(); ++k) {
    // A letter alone is an axis: A and C are units as well.
    const bool alone = lower[k].empty() || (lower[k].size() > 1 && unit_meant(lower[k]).has_value());
    if (alone && spread[k].empty() && !lower[k].empty()) return false;
    if (lower[k].empty() && spread[k].empty()) continue;
    wanting |= alone || !seen.insert(lower[k]).second;
    if (!pairs.emplace(spread[k], lower[k]).second) return false;
  }
  return wanting;
}

/// Rows that have numbers, but more words: a list of distances between named points.
void refuse_rows_of_words(const Sheet& sheet) {
  std::size_t first = sheet.rows.size(), rows = 0;
  std::string number;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    const auto& cells = sheet.rows[row];
    const auto found = std::find_if(cells.begin(), cells.end(),
                                    [&](const std::string& cell) { return is_numeric(cell, sheet); });
    if (found == cells.end()) continue;
    ++rows;
    if (first < row) continue;
    first = row;
    number = *found;
  }
  if (2 * rows <= sheet.rows.size()) return;
  throw text::InputError(
      {sheet.file, sheet.line[first]}, text::joined(sheet.rows[first], "; ").substr(0, 40),
      fmt::format("this row has more words than numbers (number: {}): a row of measured data needs the "
                  "positions of the "
                  "axes as numbers. If the words name points, add columns with the positions of the points "
                  "(X[mm], Y[mm] "
                  "and so on); for distances between points use the columns same, from and distance[mm] "
                  "(tools/docs/touch.md)",
                  number));
}

/// No row of data: the message names the probable cause.
[[noreturn]] void refuse_without_numbers(const Sheet& sheet) {
  const std::string none = "no row of this table contains numbers";
  std::size_t colons = 0;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (const std::string& cell : sheet.rows[row]) {
      if (const auto both = number_and_unit(cell, sheet.decimal_comma))
        throw text::InputError({sheet.file, sheet.line[row]}, cell,
                               fmt::format("a number with the unit {}, and {}; write the unit in the heading "
                                           "([{}]), numbers alone in the cells",
                                           both->second, none, both->second));
      const auto at = cell.find(':');
      const bool number = at != std::string::npos && plain_number(cell.substr(0, at), sheet.decimal_comma);
      colons += number && !is_date(cell) ? 1 : 0;
    }
  if (2 * colons > sheet.rows.size())
    throw text::InputError({sheet.file, sheet.line.front()}, ":",
                           "a colon cannot separate columns; save the table with semicolons or tabs");
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (const std::string& cell : sheet.rows[row])
      if (cell.starts_with('\'') &&
          (plain_number(cell.substr(1), true) || plain_number(cell.substr(1), false)))
        throw text::InputError(
            {sheet.file, sheet.line[row]}, cell,
            "an apostrophe before a number, by which a spreadsheet marks a text: delete the "
            "apostrophes (replace ' by nothing) and import the table again");
  refuse_rows_of_words(sheet);
  throw text::InputError(
      {sheet.file, sheet.line.front()}, "",
      none + (sheet.sheets.size() > 1
                  ? fmt::format("; choose the sheet with --sheet: {}", text::joined(sheet.sheets, ", "))
                  : "; columns may be separated by comma, semicolon, tab, | or blanks (--separator)"));
}

/// True for a unit of length in round brackets that is not read: "(ft)". Other words in round brackets are
/// often no units.
bool is_foreign_length(const std::string& words) {
  static const std::set<std::string> kWords = {"ft", "feet", "foot", "yd", "yard", "yards", "dm"};
  return kWords.contains(text::in_small_letters(text::trimmed(words)));
}

/// A unit may be written in two cells, and then both state the same.
void refuse_two_units(const Sheet& sheet, std::size_t row, const std::string& cell, const std::string& unit,
                      std::size_t heading_row, const std::string& heading, const std::string& heading_unit) {
  if (heading_unit.empty() || unit.empty() || unit == heading_unit) return;
  const std::string text_of_readings =
      unit_meant(cell) ? "" : "; if this line is a text about the readings, move it above the headings";
  throw text::InputError(
      {sheet.file, sheet.line[row]}, cell,
      fmt::format("the heading \"{}\" in line {} has the unit {}, this cell below it {}: "
                  "correct the wrong one of the two cells{}",
                  heading, std::to_string(sheet.line[heading_row]), heading_unit, unit, text_of_readings));
}

/// The unit of a cell in a line of headings: the cell is the unit, or has the unit; else empty.
std::string unit_of_cell(const std::string& cell) {
  const auto unit = cell.size() > 1 ? unit_meant(cell) : std::nullopt;
  return unit ? *unit : parse_heading(cell).unit;
}

/// "Messung 1" above "hin [µm]" is "Messung 1 hin [µm]".
Heading heading_of_two(const std::string& upper, const std::string& lower) {
  const auto unit = lower.size() > 1 ? unit_meant(lower) : std::nullopt;
  Heading above = parse_heading(upper), below = parse_heading(unit ? "" : lower);
  Heading both;
  both.text = text::trimmed(upper + " " + lower);
  both.name = text::trimmed(above.name + " " + below.name);
  both.unit = unit ? *unit : !below.unit.empty() ? below.unit : above.unit;
  both.unknown_unit = below.unknown_unit.empty() ? above.unknown_unit : below.unknown_unit;
  if (unit && above.unit.empty() && both.unknown_unit.empty()) take_factor(both, "");
  return both;
}

}  // namespace

bool is_line_of_units(const Sheet& sheet, std::size_t row) {
  std::size_t units = 0;
  for (const std::string& cell : sheet.rows[row]) {
    if (cell.empty()) continue;
    if (!unit_meant(cell)) return false;
    ++units;
  }
  return units > 0;
}

namespace {

/// "X [mm]", 1, 2, 3, 4: the headings of a column of positions and of the numbers of runs, above a row of
/// numbers.
bool is_line_of_run_numbers(const Sheet& sheet, std::size_t row) {
  constexpr std::size_t kFewest = 2;  // one number is a value
  const std::vector<std::string>& cells = sheet.rows[row];
  if (row + 1 >= sheet.rows.size() || cells.empty() || parse_heading(cells.front()).unit.empty() ||
      is_numeric(cells.front(), sheet) || number_and_unit(cells.front(), sheet.decimal_comma))
    return false;
  std::size_t runs = 0;
  for (std::size_t k = 1; k < cells.size() && !cells[k].empty(); ++k)
    if (cells[k] != std::to_string(++runs)) return false;
  return runs >= kFewest && is_numeric(sheet.rows[row + 1].front(), sheet);
}

}  // namespace

bool is_row_of_data(const Sheet& sheet, std::size_t row) {
  // Headings that are numbers of runs (1, 2, 3) have their units below, or beside them.
  if (row + 1 < sheet.rows.size() && is_line_of_units(sheet, row + 1)) return false;
  if (is_line_of_run_numbers(sheet, row)) return false;
  std::size_t numbers = 0, filled = 0;
  for (const std::string& cell : sheet.rows[row]) {
    filled += cell.empty() || is_date(cell) ? 0 : 1;
    numbers += !cell.empty() && is_numeric(cell, sheet) ? 1 : 0;
  }
  return numbers > 0 && 2 * numbers >= filled && (numbers > 1 || filled == 1 || sheet.rows[row].size() <= 2);
}

std::optional<std::string> unit_meant(std::string_view word) {
  const std::string bare = without_brackets(format::usual_spelling(word));
  if (bare.empty()) return std::nullopt;
  if (const auto unit = format::find_unit(bare)) return std::string(unit->name);
  std::string small = text::in_small_letters(bare);
  if (small.ends_with('.')) small.pop_back();
  for (const auto& [text, unit] : kUnitWords)
    if (small == text) return std::string(unit);
  // Capital letters that do not belong there: MM, Sec. Not for a single one: A is no a, M no m.
  if (bare.size() > 1)
    if (const auto unit = format::find_unit(small)) return std::string(unit->name);
  if (const auto part = decimal_part(bare)) return part;
  return factor_and_unit(bare);
}

std::optional<std::pair<std::string, std::string>> number_and_unit(std::string_view cell,
                                                                   bool decimal_comma) {
  const std::size_t end = cell.find_last_of("0123456789");
  if (end == std::string_view::npos || end + 1 == cell.size()) return std::nullopt;
  // The units hid the decimal sign of these cells when the sheet was read.
  auto number = plain_number(cell.substr(0, end + 1), decimal_comma);
  if (!number) number = plain_number(cell.substr(0, end + 1), !decimal_comma);
  const auto unit = unit_meant(cell.substr(end + 1));
  if (!number || !unit) return std::nullopt;
  return std::pair(*number, *unit);
}

namespace {

/// "Abweichung X µm (minus = zu weit)": the unit before a remark in brackets. "in" there is a word.
void take_unit_before_remark(Heading& heading) {
  const auto open = heading.text.rfind(" (");
  if (!heading.text.ends_with(')') || open == std::string::npos || !heading.unknown_unit.empty()) return;
  const std::string before = text::trimmed(heading.text.substr(0, open));
  const auto blank = before.rfind(' ');
  const std::string word = blank == std::string::npos ? before : before.substr(blank + 1);
  const auto unit = unit_meant(word);
  if (!unit || !word.ends_with('m') || word.size() < 2) return;  // "in" and letters are words
  heading.unit = *unit;
  const std::string name = blank == std::string::npos ? "" : text::trimmed(before.substr(0, blank));
  heading.name = text::trimmed(name + heading.text.substr(open));
}

}  // namespace

Heading parse_heading(std::string_view cell) {
  Heading heading;
  heading.text = text::trimmed(cell);
  heading.name = heading.text;
  const std::string& text = heading.text;
  const auto take = [&](std::size_t begin, std::size_t end, std::size_t name_end) {
    const std::string word = text::trimmed(text.substr(begin, end - begin));
    if (const auto unit = unit_meant(word))
      heading.unit = *unit;
    else
      return false;
    heading.name = text::trimmed(text.substr(0, name_end));
    // A sign alone is the name of an approach direction: "- [um]".
    while (heading.name.size() > 1 && std::string("/,;:-").find(heading.name.back()) != std::string::npos)
      heading.name = text::trimmed(heading.name.substr(0, heading.name.size() - 1));
    return !heading.name.empty();
  };
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')'), std::pair('<', '>')}) {
    const auto begin = text.rfind(open), end = text.rfind(close);
    if (begin == std::string::npos || end == std::string::npos || end < begin || begin == 0) continue;
    if (take(begin + 1, end, begin)) {
      const std::string behind = text.substr(end + 1);
      if (!factor_behind(behind)) {
        take_factor(heading, "");
        heading.name = text::trimmed(heading.name + " " + behind);
      } else {
        take_factor(heading, behind);
      }
      return heading;
    }
    if (open == '[' || is_foreign_length(text.substr(begin + 1, end - begin - 1))) {
      heading.unknown_unit = text::trimmed(text.substr(begin + 1, end - begin - 1));
      heading.name = text::trimmed(text.substr(0, begin));
    }
  }
  // "1/100 mm" after " in ", or at the end: the longest text that is a unit, so that "0,01 mm" is no mm.
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (std::string_view(" /,;:_").find(text[at - 1]) == std::string_view::npos || text[at] == ' ') continue;
    if (!decimal_part(text.substr(at)) || !take(at, text.size(), at)) continue;
    if (heading.name.size() > 3 && heading.name.ends_with(" in"))
      heading.name = text::trimmed(heading.name.substr(0, heading.name.size() - 3));
    return heading;
  }
  if (factor_behind_a_word(heading)) return heading;
  for (const std::string_view between : {" in ", " ", "/", ",", "_"}) {
    const auto at = text.rfind(between);
    // After a blank or _ a part of the name is more frequent than a unit: only units that do not end a name.
    const std::string rest = at == std::string::npos ? "" : text::trimmed(text.substr(at + between.size()));
    const bool weak = between == " " || between == "_";
    if (rest.empty() || at == 0 || (weak && (rest.size() < 2 || text::in_small_letters(rest) == "min")))
      continue;
    if (!take(at + between.size(), text.size(), at)) continue;
    take_factor(heading, "", true);
    return heading;
  }
  take_unit_before_remark(heading);
  return heading;
}

namespace {

/// Returns the index of the first row with data, or the number of rows if no row has data.
std::size_t first_row_of_data(const Sheet& sheet) {
  std::size_t first = 0;
  while (first < sheet.rows.size() && !is_row_of_data(sheet, first)) ++first;
  return first;
}

/// True for a row with one text of several words above rows with several cells: a title, or headings with
/// another separator.
bool is_title_alone(const Sheet& sheet, std::size_t row, std::size_t first) {
  constexpr std::size_t kFewestWords = 4;  // a heading alone in its line has fewer
  if (sheet.workbook || filled_cells(sheet.rows[row]) != 1 || filled_cells(sheet.rows[first]) < 2)
    return false;
  const auto cell = std::find_if(sheet.rows[row].begin(), sheet.rows[row].end(),
                                 [](const std::string& one) { return !one.empty(); });
  return text::words_in(*cell, " \t,;|").size() >= kFewestWords;
}

}  // namespace

void move_units_below_headings(Sheet& sheet) {
  constexpr std::size_t kLines = 3;  // names, units, runs
  const std::size_t first = first_row_of_data(sheet);
  if (first < kLines || first == sheet.rows.size()) return;
  const std::vector<std::string>&names = sheet.rows[first - kLines], &units = sheet.rows[first - 2],
        &runs = sheet.rows[first - 1];
  if (!is_units(units) || is_units(runs) || filled_cells(names) < 2) return;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (!runs[k].empty() && units[k].empty()) return;
  std::swap(sheet.rows[first - 2], sheet.rows[first - 1]);
  std::swap(sheet.line[first - 2], sheet.line[first - 1]);
  if (!sheet.written.empty()) std::swap(sheet.written[first - 2], sheet.written[first - 1]);
}

SheetTable parts_of_sheet(const Sheet& sheet) {
  SheetTable table;
  const std::size_t first = first_row_of_data(sheet);
  if (first == sheet.rows.size()) refuse_without_numbers(sheet);
  table.first_data = first;
  std::size_t heading = first;
  if (heading > 0 && is_units(sheet.rows[heading - 1])) table.units_row = --heading;
  if (heading > 0 && !is_title_alone(sheet, heading - 1, first)) {
    table.has_headings = true;
    table.heading_row = heading - 1;
  } else {
    table.units_row = 0;
  }
  if (table.has_headings && sheet.separator == ',' && !sheet.workbook) {
    if (filled_cells(sheet.rows[first]) > filled_cells(sheet.rows[table.heading_row]))
      throw text::InputError({sheet.file, sheet.line[first]},
                             text::joined(sheet.rows[first], ",").substr(0, 30),
                             "the rows have more fields than headings; if the table has decimal commas and "
                             "its columns are separated by commas, save the table with semicolons");
  }
  std::vector<std::string> upper;
  if (table.has_headings && table.heading_row > 0 && is_second_line(sheet, table.heading_row)) {
    table.upper_row = table.heading_row - 1;
    upper = spread_to_the_right(sheet.rows[*table.upper_row], sheet.rows[table.heading_row]);
  }
  for (std::size_t k = 0; k < sheet.rows.front().size(); ++k) {
    const std::string& cell = table.has_headings ? sheet.rows[table.heading_row][k] : "";
    if (!upper.empty())
      refuse_two_units(sheet, table.heading_row, cell, unit_of_cell(cell), *table.upper_row, upper[k],
                       parse_heading(upper[k]).unit);
    Heading one = upper.empty() ? parse_heading(cell) : heading_of_two(upper[k], cell);
    if (one.text.empty()) one.text = one.name = std::to_string(k + 1);
    if (table.units_row != 0)
      if (const auto unit = unit_meant(sheet.rows[table.units_row][k])) {
        refuse_two_units(sheet, table.units_row, sheet.rows[table.units_row][k], *unit, table.heading_row,
                         one.text, one.unit);
        const bool stated = !one.unit.empty() || !one.unknown_unit.empty();
        if (one.unknown_unit.empty()) one.unit = *unit;
        if (!stated) take_factor(one, "");
      }
    table.headings.push_back(std::move(one));
  }
  return table;
}

std::string name_from_words(std::string_view words) {
  static const std::vector<std::pair<std::string, std::string>> kLetters = {
      {"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"}, {"Ü", "Ue"}, {"ß", "ss"},
      {"é", "e"},  {"è", "e"},  {"Δ", "d"},  {"µ", "u"},  {"μ", "u"},  {"°", "deg"}};
  std::string text(words);
  for (const auto& [letter, spelled] : kLetters)
    for (std::size_t at = 0; (at = text.find(letter, at)) != std::string::npos;)
      text.replace(at, letter.size(), spelled);
  std::string name;
  for (const char c : text) {
    const bool good =
        std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 0x80;
    if (good)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) name = "column_" + name;
  return name;
}

}  // namespace vernier::sheet
