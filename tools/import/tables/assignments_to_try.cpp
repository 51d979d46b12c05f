// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/assignments_to_try.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/values_beside.h"
#include "tools/import/words/joint_names.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Largest error of a machine as a share of its travel (kImplausibleShare in deviation_sizes.cpp).
constexpr double kErrorShare = 0.05;

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

/// Does a column without a unit count the runs: the numbers 1 to n, each in several rows, in ascending
/// blocks?
bool counts_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                 const std::vector<SheetColumn>& columns, std::size_t k) {
  if (!columns[k].unit.empty()) return false;
  std::vector<double> values;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k);
    if (!value) continue;
    const bool next = values.empty() ? *value == 1 : *value == values.back() || *value == values.back() + 1;
    if (!next || sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma) > 0) return false;
    values.push_back(*value);
  }
  return !values.empty() && 2 * values.back() <= static_cast<double>(values.size());
}

/// True for a word of a deviation, also inside a word and in languages whose texts about the sign are not
/// read: such a column is proposed, and read only if the user says so.
bool may_name_deviation(const sheet::Heading& heading) {
  constexpr std::array<std::string_view, 14> kParts = {
      "abweich",      "fehler",      "deviat", "error", "ecart", "scosta",
      "odchy",        "afwijk",      "avvik",  "afvig", "desvi", "\u043e\u0442\u043a\u043b\u043e",
      "\u8bef\u5dee", "\u504f\u5dee"};
  const std::string small = text::in_small_letters(heading.name);
  return std::any_of(kParts.begin(), kParts.end(),
                     [&](std::string_view part) { return small.find(part) != std::string::npos; });
}

/// True for the sum of all deviations up to a position, beside the single ones.
bool names_accumulated(const sheet::Heading& heading) {
  const std::string small = text::in_small_letters(heading.name);
  return small.starts_with("summen") || small.starts_with("kumul") || small.starts_with("cumul") ||
         small.starts_with("accum");
}

/// True for a sum of several measurements, which is no reading.
bool names_sum(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const std::string small = text::in_small_letters(word);
    return small == "summe" || small == "sum" || small == "total";
  });
}

/// Range and largest size of a column, in the base unit of its heading.
struct Extent {
  double range = 0, size = 0;
};

Extent extent_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  const std::string& unit = table.headings[k].unit;
  const auto known = unit.empty() ? std::nullopt : format::find_unit(unit);
  const double factor = known ? known->factor : 1;
  std::optional<double> least, most;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, k)) {
      least = std::min(least.value_or(*value), *value);
      most = std::max(most.value_or(*value), *value);
    }
  if (!least) return {};
  return {(*most - *least) * factor, std::max(std::abs(*least), std::abs(*most)) * factor};
}

/// The axis whose letter the heading has, also without a blank before it; empty: none.
std::string axis_in(const sheet::Heading& heading, const Guess& guess) {
  for (const std::string& word : heading_words(heading.name))
    if (guess.is_axis(word)) return word;
  return "";
}

/// Target and deviation by their values, for headings in a language that is not read: the deviations are
/// below a twentieth of the range of the targets. nullopt: no two candidates are like this.
std::optional<std::pair<std::size_t, std::size_t>> target_and_deviation(
    const sheet::Sheet& sheet, const sheet::SheetTable& table, const std::vector<std::size_t>& candidates) {
  std::optional<std::size_t> target, deviation;
  for (const std::size_t k : candidates)
    if (!may_name_deviation(table.headings[k]) &&
        (!target || extent_of(sheet, table, k).range > extent_of(sheet, table, *target).range))
      target = k;
  if (!target) return std::nullopt;
  for (const std::size_t k : candidates) {
    if (k == *target ||
        !(extent_of(sheet, table, k).size < kErrorShare * extent_of(sheet, table, *target).range))
      continue;
    if (!deviation ||
        (may_name_deviation(table.headings[k]) && !may_name_deviation(table.headings[*deviation])))
      deviation = k;
  }
  return deviation ? std::optional(std::pair(*target, *deviation)) : std::nullopt;
}

/// A column with a word for a deviation that is left out because its name is that of another column: the
/// letters of its heading are not all read.
std::optional<std::size_t> deviation_of_same_name(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                                  const std::vector<SheetColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SheetColumn::Use::kLeft && columns[k].why.starts_with("column ") &&
        may_name_deviation(table.headings[k]) && sheet::number_at(sheet, table.first_data, k))
      return k;
  return std::nullopt;
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

/// True if three columns or more are turning axes: the joints of a robot.
bool angles_are_axes(const std::vector<SheetColumn>& columns, const Guess& guess) {
  constexpr std::ptrdiff_t kFewestJoints = 3;
  return std::count_if(columns.begin(), columns.end(), [&](const SheetColumn& one) {
           return one.use == SheetColumn::Use::kColumn && guess.is_axis(one.name) && !one.unit.empty() &&
                  is_angle(one.unit);
         }) >= kFewestJoints;
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
  std::vector<std::string> names;
  for (const sheet::Heading& heading : table.headings) names.push_back(heading.name);
  const bool series = !joint_series(names).empty() || angles_are_axes(columns, guess);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words) continue;
    const bool length = is_length(column.unit);
    const bool point = column.name == "X" || column.name == "Y" || column.name == "Z";
    const bool bare = series && column.unit.empty();  // a log without units
    if (point && !length && !bare) return "";
    coordinates += point ? 1 : 0;
    if (point)
      options += fmt::format("{}--column \"{}{}={}\"", options.empty() ? "" : " ",
                             text::in_small_letters(column.name), bare ? "[mm]" : "", table.headings[k].text);
    else
      joints += !length && !is_known_name(column.name) && !names_counting(table.headings[k]) &&
                        (guess.is_axis(column.name) || column.unit.empty() || is_angle(column.unit))
                    ? 1
                    : 0;
  }
  if (coordinates < kFewestCoordinates) options = options.empty() ? named_triple(table, columns) : "";
  return joints >= kFewestJoints && !options.empty()
             ? options +
                   " (the point that an instrument measured in the poses of a robot; a position that the "
                   "control shows is computed from the joints, and is no measurement)"
             : "";
}

/// Options for distances between named points ("Abstand [mm]" beside "von"); empty: the table has no such
/// pair.
std::string distances_between_points(const sheet::SheetTable& table,
                                     const std::vector<SheetColumn>& columns) {
  const auto has_word = [&](std::size_t k, std::initializer_list<std::string_view> known) {
    const std::vector<std::string> words = heading_words(table.headings[k].name);
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return std::find(known.begin(), known.end(), text::in_small_letters(word)) != known.end();
    });
  };
  std::optional<std::size_t> distance, from;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn) continue;
    if (!columns[k].words && has_word(k, {"abstand", "distanz", "entfernung", "distance", "dist", "strecke",
                                          "länge", "diagonale", "diagonal"}))
      distance = k;
    if (columns[k].words && has_word(k, {"von", "from", "ab", "de", "da", "start", "bezug"})) from = k;
  }
  if (!distance || !from) return "";
  return fmt::format(
      "--column \"distance{}={}\" --column \"from={}\" (distances between points of the table)",
      table.headings[*distance].unit.empty() ? "[mm]" : "", table.headings[*distance].text,
      table.headings[*from].text);
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

/// Options beside an axis with a name of its own (slide, base_to_turret): no reading is along its name, and a
/// deviation of the axis would have no column. `reading`: the column of the reading; no value: not known.
std::string beside_own_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                            const std::vector<SheetColumn>& columns, std::size_t position,
                            std::optional<std::size_t> reading) {
  const std::string unit = reading ? columns[*reading].unit : "";
  const std::string heading = reading ? table.headings[*reading].text : "HEADING";
  const bool angle = !unit.empty() && is_angle(unit);
  if (reading && !angle && is_length(columns[position].unit) &&
      extent_of(sheet, table, *reading).size < kErrorShare * extent_of(sheet, table, position).range)
    return fmt::format(
        "--column \"x[mm]=SUM\" with a new column SUM of the table: the position of {} plus \"{}\" (the "
        "values are small compared with the positions: deviations, and a deviation along {} has no column)",
        columns[position].name, heading, columns[position].name);
  return fmt::format("--column \"{}{}={}\" for a measured {}{}{}",
                     angle ? format::columns::kRotation[0] : format::columns::kPoint[0],
                     unit.empty() ? "[mm]" : "", heading,
                     angle ? "rotation (rx, ry or rz)" : "coordinate (x, y or z)",
                     reading ? "" : ", with a heading of the table in the place of HEADING",
                     unit.empty() ? "; [mm] is an example: state the unit of the values" : "");
}

}  // namespace

std::string assignments_to_try(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                               const std::vector<SheetColumn>& columns, const Guess& guess) {
  if (std::string robot = point_of_robot(table, columns, guess); !robot.empty()) return robot;
  if (std::string distances = distances_between_points(table, columns); !distances.empty()) return distances;
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
  std::vector<std::size_t> candidates;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.words || guess.is_axis(column.name) ||
        guess.is_motion(column.name) || is_sense(column.name) || is_known_name(column.name) ||
        names_counting(table.headings[k]) || counts_rows(sheet, table, k) ||
        counts_runs(sheet, table, columns, k) || names_sum(table.headings[k]) ||
        (joints && is_angle(column.unit)))
      continue;
    candidates.push_back(k);
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
    } else if (reading.empty() || (bare == Guess::Bare::kActual && !actual) ||
               (!actual && may_name_deviation(table.headings[k]) &&
                (!may_name_deviation(table.headings[*at_reading]) ||
                 (names_accumulated(table.headings[k]) &&
                  !names_accumulated(table.headings[*at_reading]))))) {
      at_reading = k;
      reading = table.headings[k].text;
      unit = column.unit;
      actual = bare == Guess::Bare::kActual;
      correction = names_correction(table.headings[k]);
    }
  }
  if (axis == columns.end() && position.empty() && !actual)
    if (const auto pair = target_and_deviation(sheet, table, candidates)) {
      const sheet::Heading &target = table.headings[pair->first], &deviation = table.headings[pair->second];
      if (const std::string found = axis_in(target, guess); !found.empty()) name = found;
      const bool examples = target.unit.empty() || deviation.unit.empty();
      return fmt::format(
          "--column \"{0}{1}={2}\" --deviation \"{0}{3}={4}\" (the values of the second column are small "
          "compared with those of the first one: deviations){5}",
          name, target.unit.empty() ? "[mm]" : "", target.text, deviation.unit.empty() ? "[um]" : "",
          deviation.text, examples ? "; [mm] and [um] are examples: state the unit of the values" : "");
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
  if (reading.empty())
    if (const auto other = deviation_of_same_name(sheet, table, columns))
      return fmt::format("--deviation \"{}{}={}\"", name, table.headings[*other].unit.empty() ? "[um]" : "",
                         table.headings[*other].text);
  if (axis != columns.end() && !reading_of(name))
    return beside_own_axis(sheet, table, columns, *at_position, at_reading);
  // Without a heading of positions, the values show which column is the target of another one.
  const auto pair_of = [&](std::size_t target, std::size_t other) {
    return ColumnPair{target, other, columns[target].unit, columns[other].unit};
  };
  for (std::size_t i = 1; axis == columns.end() && !at_position && i < candidates.size(); ++i) {
    const std::size_t target = candidates.front(), other = candidates[i];
    if (values_beside(sheet, table, pair_of(target, other)) == Values::kUnclear) continue;
    at_position = target;
    at_reading = other;
    position = fmt::format("--column \"{}{}={}\" ", name, columns[target].unit.empty() ? "[mm]" : "",
                           table.headings[target].text);
    reading = table.headings[other].text;
    unit = columns[other].unit;
    correction = false;
  }
  const bool open_heading = reading.empty();
  if (open_heading) reading = "HEADING";
  std::string which = unit.empty() ? "; [mm] and [um] are examples: state the unit of the values" : "";
  if (open_heading)
    which =
        ", with a heading of the table in the place of HEADING" + which +
        " (no column looks like a reading; a sum of several measurements must be divided by their number)";
  if (correction)
    return fmt::format("{}--deviation \"{}{}={}\" (a correction is nominal - actual: its sign is reversed){}",
                       position, name, unit.empty() ? "[um]" : "", reading, which);
  const std::string as_position = fmt::format(
      "{}--column \"{}{}={}\"", position, reading_of(name).value_or("x"),
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[mm]" : "[deg]") : "", reading);
  const std::string as_deviation = fmt::format(
      "{}--deviation \"{}{}={}\"", position, name,
      unit.empty() ? (reading_of(name) == text::in_small_letters(name) ? "[um]" : "[arcsec]") : "", reading);
  const ColumnPair pair = at_position && at_reading ? pair_of(*at_position, *at_reading) : ColumnPair{};
  const Values values = pair.position != pair.reading ? values_beside(sheet, table, pair) : Values::kUnclear;
  switch (values) {
    case Values::kDeviations:
      return fmt::format(
          "{} (the values are small compared with the positions) if they are deviations, actual - nominal; "
          "for nominal - actual, such as corrections or remaining distances, add --sign nominal-actual; sum "
          "changes from row to row in the file first",
          as_deviation);
    case Values::kPositions:
      return fmt::format("{} (the values follow the positions)", as_position);
    case Values::kOpposite:
    case Values::kFalling:
    case Values::kSteps:
      return fmt::format("{}, but {}", as_position, work_before_reading(sheet, table, values, pair));
    case Values::kUnclear:
      break;
  }
  return fmt::format("{} for a measured position, or {} for a deviation{}", as_position, as_deviation, which);
}

}  // namespace vernier::importer
