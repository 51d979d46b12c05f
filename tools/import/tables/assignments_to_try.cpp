// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/assignments_to_try.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/maths/median.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// What the values of a column are, beside the positions of an axis.
enum class Values { kUnclear, kPositions, kDeviations, kOpposite, kSteps };

/// The axis of a heading with a word for the position that the control shows: "X Anzeige".
std::string axis_shown(const sheet::Heading& heading, const Guess& guess) {
  std::string axis;
  bool display = false;
  for (const std::string& word : heading_words(heading.name)) {
    display |= says_display(text::in_small_letters(word));
    if (guess.is_axis(word)) axis = word;
  }
  return display ? axis : "";
}

/// Compares the values of a column with the positions of an axis, row by row. Without units on both sides the
/// result is kUnclear.
Values values_beside(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                     const std::vector<SheetColumn>& columns, std::size_t position, std::size_t reading) {
  const auto from = format::find_unit(columns[position].unit), to = format::find_unit(columns[reading].unit);
  if (!from || !to || columns[position].unit.empty() || columns[reading].unit.empty() ||
      from->dimension != to->dimension)
    return Values::kUnclear;
  std::vector<double> at, value, size, apart, sum, step;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto a = sheet::number_at(sheet, row, position), b = sheet::number_at(sheet, row, reading);
    if (!a || !b) continue;
    if (!at.empty()) step.push_back(std::abs(*b * to->factor - (*a * from->factor - at.back())));
    at.push_back(*a * from->factor);
    value.push_back(*b * to->factor);
    size.push_back(std::abs(value.back()));
    apart.push_back(std::abs(value.back() - at.back()));
    sum.push_back(std::abs(value.back() + at.back()));
  }
  constexpr std::size_t kEnough = 4;  // fewer rows show no pattern
  if (at.size() < kEnough) return Values::kUnclear;
  const auto [least, most] = std::minmax_element(at.begin(), at.end());
  const double travel = *most - *least;
  // No machine has errors of a twentieth of its travel (kImplausibleShare in deviation_sizes.cpp).
  constexpr double kShare = 0.05;
  if (!(travel > 0)) return Values::kUnclear;
  if (*std::max_element(size.begin(), size.end()) < kShare * travel) return Values::kDeviations;
  if (maths::median(apart) < kShare * travel) return Values::kPositions;
  if (maths::median(sum) < kShare * travel) return Values::kOpposite;
  // The steps are a part of the travel: they agree within a twentieth of themselves.
  if (maths::median(step) < kShare * maths::median(size)) return Values::kSteps;
  return Values::kUnclear;
}

/// Does a heading only count or name its rows?
bool names_counting(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(heading.name);
  return !words.empty() && std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return says_counting(text::in_small_letters(word));
  });
}

bool is_length(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return !unit.empty() && found && found->dimension == format::Dimension::kLength;
}

/// The coordinate x, y or z that ends a heading, and the text before the coordinate: "Tx", "tracker_x", "P
/// X".
struct Coordinate {
  std::string prefix;
  char of = 0;  // 'x', 'y', 'z'; 0: the heading does not end with a coordinate
};

Coordinate coordinate_of(const std::string& name) {
  const std::string small = text::in_small_letters(name);
  constexpr std::string_view kCoordinates = "xyz";
  if (small.empty() || kCoordinates.find(small.back()) == std::string_view::npos) return {};
  return {small.substr(0, small.size() - 1), small.back()};
}

/// Options that make three columns of lengths whose names differ in the coordinate alone (Tx, Ty, Tz) the
/// measured point. Empty if the table does not have exactly one such triple.
std::string named_triple(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns) {
  std::map<std::string, std::map<char, std::size_t>> triples;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words || !is_length(column.unit)) continue;
    const Coordinate coordinate = coordinate_of(table.headings[k].name);
    if (coordinate.of != 0) triples[coordinate.prefix].emplace(coordinate.of, k);
  }
  constexpr std::size_t kCoordinates = 3;  // x, y and z
  std::string options;
  for (const auto& [prefix, triple] : triples) {
    if (triple.size() != kCoordinates) continue;
    if (!options.empty()) return "";
    for (const auto& [of, k] : triple)
      options += fmt::format("{}--column \"{}={}\"", options.empty() ? "" : " ", of, table.headings[k].text);
  }
  return options;
}

/// Options that make the columns of a point (X, Y, Z, or one triple such as Tx, Ty, Tz) in a unit of length
/// the measured point, if most other columns of numbers have no unit or the unit of an angle: poses of a
/// robot by its joints. Empty for other tables.
std::string point_of_robot(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns,
                           const Guess& guess) {
  constexpr std::size_t kFewestJoints = 3;       // fewer columns may be temperatures or loads
  constexpr std::size_t kFewestCoordinates = 2;  // one coordinate is the position of an axis, beside its runs
  std::string options;
  std::size_t joints = 0, coordinates = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words) continue;
    const bool length = is_length(column.unit);
    const bool point = column.name == "X" || column.name == "Y" || column.name == "Z";
    if (point && !length) return "";
    coordinates += point ? 1 : 0;
    if (point)
      options += fmt::format("{}--column \"{}={}\"", options.empty() ? "" : " ",
                             text::in_small_letters(column.name), table.headings[k].text);
    else
      joints += !length && !is_known_name(column.name) && !names_counting(table.headings[k]) &&
                        (guess.is_axis(column.name) || column.unit.empty() || is_angle(column.unit))
                    ? 1
                    : 0;
  }
  if (coordinates < kFewestCoordinates) options = options.empty() ? named_triple(table, columns) : "";
  return joints >= kFewestJoints && !options.empty()
             ? options + " (the point that was measured in the poses of a robot)"
             : "";
}

/// True if the angles of a table are the joints of a robot: three or more of them beside a length.
bool angles_are_joints(const std::vector<SheetColumn>& columns) {
  constexpr std::ptrdiff_t kFewestJoints = 3;
  const auto numbers = [](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && !one.words && !is_known_name(one.name);
  };
  return std::count_if(columns.begin(), columns.end(),
                       [&](const SheetColumn& one) {
                         return numbers(one) && is_angle(one.unit) && !one.unit.empty();
                       }) >= kFewestJoints &&
         std::any_of(columns.begin(), columns.end(),
                     [&](const SheetColumn& one) { return numbers(one) && is_length(one.unit); });
}

}  // namespace

std::string assignments_to_try(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                               const std::vector<SheetColumn>& columns, const Guess& guess) {
  if (std::string robot = point_of_robot(table, columns, guess); !robot.empty()) return robot;
  const auto axis = std::find_if(columns.begin(), columns.end(), [&](const SheetColumn& column) {
    return column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name);
  });
  std::string position, reading, unit;
  std::optional<std::size_t> at_position, at_reading;
  if (axis != columns.end()) at_position = static_cast<std::size_t>(axis - columns.begin());
  std::string name = axis == columns.end() ? axis_to_try(sheet, table) : axis->name;
  bool actual = false, correction = false;
  const auto has = [&](Guess::Bare kind) {
    return std::any_of(table.headings.begin(), table.headings.end(),
                       [&](const sheet::Heading& one) { return Guess::bare(one.name) == kind; });
  };
  const bool joints = angles_are_joints(columns);
  const bool shown = !has(Guess::Bare::kTarget) && has(Guess::Bare::kActual);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words || guess.is_axis(column.name) ||
        guess.is_motion(column.name) || is_sense(column.name) || is_known_name(column.name) ||
        names_counting(table.headings[k]) || counts_rows(sheet, table, k) ||
        (joints && is_angle(column.unit)))
      continue;
    Guess::Bare bare = Guess::bare(table.headings[k].name);
    if (bare == Guess::Bare::kDisplay && shown) bare = Guess::Bare::kTarget;
    const std::string shown_axis = axis_shown(table.headings[k], guess);
    if (!shown_axis.empty() && shown && axis == columns.end() && position.empty()) {
      name = shown_axis;
      at_position = k;
      position = fmt::format("--column \"{}{}={}\" ", name, column.unit.empty() ? "[mm]" : "",
                             table.headings[k].text);
      continue;
    }
    if (bare == Guess::Bare::kTarget && axis == columns.end() && position.empty()) {
      at_position = k;
      position = fmt::format("--column \"{}{}={}\" ", name, column.unit.empty() ? "[mm]" : "",
                             table.headings[k].text);
    } else if (reading.empty() || (bare == Guess::Bare::kActual && !actual)) {
      at_reading = k;
      reading = table.headings[k].text;
      unit = column.unit;
      actual = bare == Guess::Bare::kActual;
      correction = names_correction(table.headings[k]);
    }
  }
  const auto open = std::find_if(columns.begin(), columns.end(), [](const SheetColumn& column) {
    return column.use == SheetColumn::Use::kLeft && column.name.empty() &&
           column.why.find("the axis of this deviation is not known") == 0;
  });
  const auto at_open = static_cast<std::size_t>(open - columns.begin());
  if (open != columns.end() && !actual)
    return fmt::format("{}--deviation \"{}{}={}\"{}{}", position, name, open->unit.empty() ? "[um]" : "",
                       table.headings[at_open].text,
                       position.empty() && axis == columns.end()
                           ? " " + option_of_positions(sheet, table, columns, guess, at_open)
                           : "",
                       open->unit.empty() ? "; [um] is an example: state the unit of the values" : "");
  // A column that was left out has the options that read it.
  if (reading.empty())
    for (const SheetColumn& column : columns)
      if (const auto at = column.why.find("--"); column.use == SheetColumn::Use::kLeft &&
                                                 at != std::string::npos &&
                                                 !column.why.starts_with("column "))
        return column.why.substr(at);
  if (reading.empty()) reading = "HEADING";
  const std::string which = unit.empty() ? "; [mm] and [um] are examples: state the unit of the values" : "";
  if (correction)
    return fmt::format("{}--deviation \"{}{}={}\" (a correction is nominal - actual: its sign is reversed){}",
                       position, name, unit.empty() ? "[um]" : "", reading, which);
  const std::string as_position = fmt::format(
      "{}--column \"{}{}={}\"", position, reading_of(name).value_or("x"),
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[mm]" : "[deg]") : "", reading);
  const std::string as_deviation = fmt::format(
      "{}--deviation \"{}{}={}\"", position, name,
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[um]" : "[arcsec]") : "", reading);
  const Values values = at_position && at_reading && at_position != at_reading
                            ? values_beside(sheet, table, columns, *at_position, *at_reading)
                            : Values::kUnclear;
  switch (values) {
    case Values::kDeviations:
      return fmt::format("{} (the values are small compared with the positions: deviations)", as_deviation);
    case Values::kPositions:
      return fmt::format("{} (the values follow the positions)", as_position);
    case Values::kOpposite:
      return fmt::format(
          "{}, but first change the sign of \"{}\" in the file: its values are the positions with "
          "the opposite sign",
          as_position, reading);
    case Values::kSteps:
      return fmt::format(
          "{}, but first replace the values of \"{}\" in the file by their sums from the first row "
          "to each row: the values are the steps from row to row",
          as_position, reading);
    case Values::kUnclear:
      break;
  }
  return fmt::format("{} for a measured position, or {} for a deviation{}", as_position, as_deviation, which);
}

}  // namespace vernier::importer
