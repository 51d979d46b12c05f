// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/nominal_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/logs/nominal_points.h"
#include "tools/import/reading/sheet_import.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr const char* kPointTwice = "the list of nominal positions has this point twice";

/// The number in a cell of the list, with a decimal point, as the machine file counts the axis.
std::string position_cell(const ListedRows& list, std::size_t i, std::size_t column,
                          const model::Axis& axis) {
  const std::string& cell = list.cell(i, column);
  const auto number = sheet::plain_number(cell, list.reading.sheet.decimal_comma);
  if (!number)
    throw text::InputError(list.place(i), cell, "not a number, for the nominal position of " + axis.name);
  const auto counting = list.counting.find(axis.name);
  if (counting == list.counting.end()) return *number;
  return text::number_text(counting->second.position(*text::parse_number(*number)));
}

/// The column with the names of the points: the first one that is no axis and has a cell in each row.
std::size_t column_of_names(const ListedRows& list, const model::Machine& machine) {
  const std::vector<SheetColumn>& columns = list.reading.columns;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use == SheetColumn::Use::kDeviation || machine.find_axis(columns[k].name)) continue;
    bool all = true;
    for (std::size_t i = 0; i < list.rows.size(); ++i) all = all && !list.cell(i, k).empty();
    if (all) return k;
  }
  throw text::InputError(list.heading(), "",
                         "the list of nominal positions has no column with the names of the points");
}

/// The part of a point's name that lists share: "A::Vol::P1" is "p1".
std::string key_of(const std::string& name) {
  const auto at = name.rfind("::");
  return text::in_small_letters(text::trimmed(at == std::string::npos ? name : name.substr(at + 2)));
}

bool has_words(const std::vector<std::string>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const std::string& cell) { return !cell.empty() && !text::parse_number(cell); });
}

/// True for the heading of a column with the names of points: "Punkt", "Pt. No.".
bool names_points(std::string heading) {
  static const std::set<std::string> kWords = {
      "point", "pt",     "punkt",  "pkt",  "messpunkt", "name",    "id",        "nr",
      "no",    "nummer", "number", "pose", "punktname", "punktnr", "pointname", "pointid"};
  for (char& c : heading)
    if (c == '.' || c == '-' || c == '_' || c == '#' || c == ':') c = ' ';
  std::istringstream words(text::in_small_letters(heading));
  std::string word;
  bool all = false;
  while (words >> word) {
    if (!kWords.contains(word)) return false;
    all = true;
  }
  return all;
}

/// A column of names of the points, and one of the list that can have the same names.
struct NamesInBoth {
  const ImportTable::Column& of_points;
  std::size_t of_list = 0;
  bool stated = false;   // the same heading, or the user's assignment
  bool numbers = false;  // below two headings that name points: each file can count in its own way
};

std::vector<std::string> cells_of(const ListedRows& list, std::size_t column) {
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < list.rows.size(); ++i) cells.push_back(list.cell(i, column));
  return cells;
}

/// The pairs of columns that can have the names of the points in both files: with words (`numbers` false) or
/// under the same heading, or with numbers below two headings that name points.
std::vector<NamesInBoth> columns_of_names(const ImportTable& points, const ListedRows& list, bool numbers) {
  std::vector<NamesInBoth> pairs;
  for (const ImportTable::Column& column : points.columns) {
    if (!column.unit.empty() || format::find_column(column.name) != nullptr) continue;
    for (std::size_t k = 0; k < list.reading.columns.size(); ++k) {
      const std::string& heading = list.reading.table.headings[k].name;
      const bool stated = text::in_small_letters(heading) == text::in_small_letters(column.name) ||
                          list.reading.columns[k].name == column.name;
      const bool words = has_words(cells_of(list, k)) && has_words(column.cells);
      if (numbers ? !stated && !words && names_points(column.name) && names_points(heading) : stated || words)
        pairs.push_back({column, k, stated, numbers});
    }
  }
  return pairs;
}

/// The row of the list for each point; no value: the list has no row of this name, or several with this
/// number.
std::vector<std::optional<std::size_t>> rows_of_names(const NamesInBoth& both, const ListedRows& list) {
  const std::vector<std::string> own = cells_of(list, both.of_list);
  std::map<std::string, std::vector<std::size_t>> index;
  for (std::size_t i = 0; i < own.size(); ++i) index[key_of(own[i])].push_back(i);
  std::vector<std::optional<std::size_t>> rows;
  for (const std::string& name : both.of_points.cells) {
    const auto at = index.find(key_of(name));
    const std::size_t n = at == index.end() ? 0 : at->second.size();
    if (n > 1 && !both.numbers)
      throw text::InputError(list.place(at->second[1]), own[at->second[1]], kPointTwice);
    rows.push_back(n == 1 ? std::optional(at->second.front()) : std::nullopt);
  }
  return rows;
}

/// The rows if each point has one; empty: a name is missing.
std::vector<std::size_t> complete(const std::vector<std::optional<std::size_t>>& found) {
  std::vector<std::size_t> rows;
  for (const std::optional<std::size_t>& row : found)
    if (row) rows.push_back(*row);
  return rows.size() == found.size() ? rows : std::vector<std::size_t>{};
}

/// Row of the list for each point, by a column of names in both; empty: there is no such column.
std::vector<std::size_t> rows_by_name(const ImportTable& points, const ListedRows& list, std::string& names) {
  for (const NamesInBoth& both : columns_of_names(points, list, false)) {
    const std::vector<std::optional<std::size_t>> found = rows_of_names(both, list);
    if (std::vector<std::size_t> rows = complete(found); !rows.empty()) {
      names = both.of_points.name;
      return rows;
    }
    const auto missing = std::find(found.begin(), found.end(), std::nullopt);
    const auto at = static_cast<std::size_t>(missing - found.begin());
    const auto without = static_cast<std::size_t>(std::count(found.begin(), found.end(), std::nullopt));
    if (both.stated || 2 * without < found.size())
      throw text::InputError({points.file, points.line[at]}, both.of_points.cells[at],
                             fmt::format("the list of nominal positions ({}) has no point of this name",
                                         list.reading.sheet.file));
  }
  return {};
}

/// Adds the positions of the axes that the points do not have; `rows`: the row of the list for each row.
void add_positions(ImportTable& table, const ImportTable& points, const ListedRows& list,
                   const std::vector<std::size_t>& rows, const model::Machine& machine) {
  for (const model::Axis& axis : machine.axes) {
    if (points.find(axis.name) != nullptr) continue;
    const std::size_t k = column_of_axis(list, axis);
    ImportTable::Column column{axis.name, list.reading.columns[k].unit, {}};
    for (const std::size_t i : rows) column.cells.push_back(position_cell(list, i, k, axis));
    table.columns.push_back(std::move(column));
  }
}

/// The points with the positions of the axes; `rows`: the row of the list for each point.
ImportTable joined(const ImportTable& points, const ListedRows& list, const std::vector<std::size_t>& rows,
                   const model::Machine& machine) {
  ImportTable table{points.file, {}, points.line};
  add_positions(table, points, list, rows, machine);
  table.columns.insert(table.columns.end(), points.columns.begin(), points.columns.end());
  return table;
}

/// The positions of all rows of the list, also of those without a point.
ImportTable all_positions(const ImportTable& points, const ListedRows& list, const model::Machine& machine) {
  ImportTable positions{list.reading.sheet.file, {}, {}};
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < list.rows.size(); ++i) {
    positions.line.push_back(list.place(i).line);
    all.push_back(i);
  }
  add_positions(positions, points, list, all, machine);
  return positions;
}

ToolPlace place_of(const model::Machine& machine) {
  return machine.tool_shifts.empty() ? ToolPlace::kOfTheMachine : ToolPlace::kUnknown;
}

Eigen::VectorXd distances(const ImportTable& table, const model::Machine& machine) {
  return distances_from_nominal(table, machine, place_of(machine));
}

/// Row of the list for each point, where points are missing and nothing names them; empty: the distances do
/// not tell.
std::vector<std::size_t> rows_by_distances(const ImportTable& points, const ListedRows& list,
                                           const model::Machine& machine, double tolerance_mm) {
  const std::optional<Eigen::Matrix3Xd> measured = measured_points(points);
  const bool has_axes = std::any_of(machine.axes.begin(), machine.axes.end(), [&](const model::Axis& axis) {
    return points.find(axis.name) != nullptr;
  });
  if (!measured || has_axes) return {};
  return poses_in_order(nominal_poses(all_positions(points, list, machine), machine), *measured,
                        place_of(machine), tolerance_mm);
}

/// How the rows of a list were found.
struct JoinedRows {
  std::vector<std::size_t> rows;  // of the list, for each point
  std::string names;              // as in NominalTable
  bool by_distances = false;
};

/// Row of the list for each point, where no name joins them; empty: neither numbers nor distances tell.
std::vector<std::size_t> rows_without_names(const ImportTable& points, const ListedRows& list,
                                            const model::Machine& machine, double tolerance_mm) {
  if (points.line.size() > list.rows.size()) return {};
  if (points.line.size() < list.rows.size()) return rows_by_distances(points, list, machine, tolerance_mm);
  std::vector<std::size_t> rows(list.rows.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

/// Largest distance of a point from its nominal position, mm; 0: the points cannot be compared.
double largest_distance_mm(const ImportTable& points, const ListedRows& list,
                           const std::vector<std::size_t>& rows, const model::Machine& machine) {
  const Eigen::VectorXd off = distances(joined(points, list, rows, machine), machine);
  return off.size() == 0 ? 0 : off.maxCoeff();
}

JoinedRows rows_of_points(const ImportTable& points, const ListedRows& list, const model::Machine& machine,
                          double tolerance_mm) {
  JoinedRows result;
  result.rows = rows_by_name(points, list, result.names);
  if (!result.names.empty()) return result;
  result.rows = rows_without_names(points, list, machine, tolerance_mm);
  result.by_distances = points.line.size() != list.rows.size();
  // Both files can count the points each in its own way: the distances decide.
  for (const NamesInBoth& both : columns_of_names(points, list, true)) {
    const std::vector<std::size_t> rows = complete(rows_of_names(both, list));
    if (rows.empty() || (!result.rows.empty() && largest_distance_mm(points, list, rows, machine) >
                                                     largest_distance_mm(points, list, result.rows, machine)))
      continue;
    return {rows, both.of_points.name, false};
  }
  const bool lost = points.line.size() < list.rows.size();
  if (result.rows.empty())
    throw text::InputError(
        list.heading(), "",
        fmt::format(
            "{} has {} points, this list has {} positions, and no column of names joins them{}. If the "
            "file of points has the names of the points, read them too (--column \"HEADING=point\"); "
            "otherwise {}",
            points.file, points.line.size(), list.rows.size(),
            lost ? "; the distances between the points do not show which positions have no point" : "",
            lost ? "omit the positions without a point from the list"
                 : "omit the points without a position from their file"));
  return result;
}

constexpr double kTolerances = 3;  // of a point from its position, as in pair_points

/// Largest distance of a point from its nominal position, mm, if the joints of the list are in `unit`; no
/// value: the points cannot be compared.
std::optional<double> farthest_mm(ImportTable table, const ImportTable& points, const model::Machine& machine,
                                  const std::string& unit) {
  for (ImportTable::Column& column : table.columns)
    if (const auto axis = machine.find_axis(column.name);
        axis && machine.axes[*axis].rotary && points.find(column.name) == nullptr)
      column.unit = unit;
  const Eigen::VectorXd off = distances(table, machine);
  return off.size() == 0 ? std::nullopt : std::optional(off.maxCoeff());
}

/// What the points say about joints without units, and the unit in which they agree: changes `list.open`.
std::string settle_units(const ImportTable& points, ListedRows& list, const model::Machine& machine,
                         double tolerance_mm) {
  ListedRows proposed = list;
  assign_open_axes(proposed);
  std::optional<double> degrees, radians;
  try {
    const ImportTable table =
        joined(points, proposed, rows_of_points(points, proposed, machine, tolerance_mm).rows, machine);
    degrees = farthest_mm(table, points, machine, "deg");
    radians = farthest_mm(table, points, machine, "rad");
  } catch (const text::InputError&) {
    return "";  // the lists cannot be joined yet: the next call says why
  }
  if (!degrees || !radians) return "";
  const double limit = kTolerances * tolerance_mm;
  if ((*degrees > limit) == (*radians > limit)) return "";
  const bool in_radians = *radians <= limit;
  for (FreeColumn& column : list.open.columns)
    if (column.assumed != "mm") column.assumed = in_radians ? "rad" : "deg";
  return fmt::format(
      ". In {} the points agree with the nominal machine within {:.3g} mm (in {}: {:.3g} mm): the joints are "
      "in [{}]",
      in_radians ? "radians" : "degrees", in_radians ? *radians : *degrees,
      in_radians ? "degrees" : "radians", in_radians ? *degrees : *radians, in_radians ? "rad" : "deg");
}

/// The other unit of angles, if all points agree in it: a sentence with the way on; empty: they do not.
std::string other_unit(const ImportTable& table, const ImportTable& points, const ListedRows& list,
                       const NominalList& nominal, const model::Machine& machine, double tolerance_mm) {
  std::vector<std::size_t> joints;
  std::vector<std::string> units;
  for (const model::Axis& axis : machine.axes) {
    if (!axis.rotary || points.find(axis.name) != nullptr) continue;
    joints.push_back(column_of_axis(list, axis));
    units.push_back(list.reading.columns[joints.back()].unit);
  }
  const bool degrees =
      std::all_of(units.begin(), units.end(), [](const auto& unit) { return unit == "deg"; });
  const bool radians =
      std::all_of(units.begin(), units.end(), [](const auto& unit) { return unit == "rad"; });
  if (joints.empty() || (!degrees && !radians) || (degrees && !may_be_radians(list.reading, joints)))
    return "";
  const std::string other = degrees ? "rad" : "deg";
  const std::optional<double> off = farthest_mm(table, points, machine, other);
  if (!off || *off > kTolerances * tolerance_mm) return "";
  std::vector<std::string> words;
  std::string stated;
  for (const std::size_t k : joints) {
    const sheet::Heading& heading = list.reading.table.headings[k];
    if (!heading.unit.empty()) stated += (stated.empty() ? "" : ", ") + heading.text;
    words.push_back(fmt::format("{}[{}]={}", list.reading.columns[k].name, other, heading.text));
  }
  const std::string found = fmt::format("In {} the points agree within {:.3g} mm: write [{}]",
                                        degrees ? "radians" : "degrees", *off, other);
  if (!stated.empty())
    return fmt::format("{} in the place of [{}] in the headings of {} ({})", found, units.front(),
                       list.reading.sheet.file, stated);
  return fmt::format("{}, give: {}", found, way_on(nominal, list, words));
}

/// The other unit of the points, if all of them agree in it: a sentence with the unit, and the call that goes
/// on; empty: they do not.
std::string other_unit_of_points(const ImportTable& table, const NominalList& nominal,
                                 const model::Machine& machine, double tolerance_mm) {
  const ImportTable::Column& first = *table.find(format::columns::kPoint[0]);
  for (const char* unit : {"mm", "m", "in", "cm"}) {
    if (unit == first.unit) continue;
    ImportTable other = table;
    std::string words;
    for (const char* name : format::columns::kPoint) {
      for (ImportTable::Column& column : other.columns)
        if (column.name == name) column.unit = unit;
      words += fmt::format("{}{}[{}]", words.empty() ? "" : ", ", name, unit);
    }
    const Eigen::VectorXd off = distances(other, machine);
    if (off.size() == 0 || off.maxCoeff() > kTolerances * tolerance_mm) continue;
    const std::string call = nominal.call_in_unit ? nominal.call_in_unit(unit) : "";
    return fmt::format("With the points in [{}] in the place of [{}] they agree within {:.3g} mm: write {}{}",
                       unit, first.unit, off.maxCoeff(), words, call.empty() ? "" : ", give: " + call);
  }
  return "";
}

/// Joints that the list counts in the other direction or from another zero, if the points agree with them: a
/// sentence with the call that goes on; empty: they do not. `given_mm`: the largest distance as given.
std::string other_counting(const ImportTable& table, const ImportTable& points, const ListedRows& list,
                           const NominalList& nominal, const model::Machine& machine, double limit_mm,
                           double given_mm) {
  if (!list.counting.empty()) return "";
  std::vector<std::string> axes;
  for (const model::Axis& axis : machine.axes)
    if (points.find(axis.name) == nullptr) axes.push_back(axis.name);
  const std::optional<OtherCounting> other =
      counting_that_agrees(table, machine, axes, place_of(machine), limit_mm, given_mm);
  if (!other) return "";
  std::vector<std::string> words, said;
  for (const std::string& axis : axes) {
    const std::size_t k = column_of_axis(list, machine.axes[*machine.find_axis(axis)]);
    CountedHeading heading{list.reading.table.headings[k].text, {}};
    if (const auto one = other->axes.find(axis); one != other->axes.end()) {
      heading.counting = one->second;
      said.push_back(fmt::format("{} = {}", axis, in_words(heading)));
    }
    words.push_back(fmt::format("{}[{}]={}", axis, list.reading.columns[k].unit, in_words(heading)));
  }
  return fmt::format(
      "With {} all points agree within {:.3g} mm (as given: {:.3g} mm): the list counts {} in the other "
      "direction or from another zero than the machine file. If this is so, give: {}",
      text::joined(said, ", "), other->farthest_mm, given_mm, said.size() == 1 ? "this axis" : "these axes",
      way_on(nominal, list, words));
}

/// What to look at if no other reading of the files makes the points agree.
std::string what_to_check(const model::Machine& machine, bool without_names, double off_mm,
                          double tolerance_mm) {
  constexpr double kMostOfAMachine = 5;  // times the permitted distance: a robot before its calibration
  std::string text = ": check the order and the names of both lists";
  const bool turns = std::any_of(machine.axes.begin(), machine.axes.end(),
                                 [](const model::Axis& axis) { return axis.rotary; });
  if (machine.tool_shifts.empty() && turns)
    text +=
        "; if the points are those of a reflector at an unknown place on the tool, declare it in the machine "
        "file (vernier set MACHINE --reflector)";
  if (without_names)
    text +=
        "; row n of the list was taken as point n: if the points have another order, both files need a "
        "column with the names of the points";
  if (off_mm <= kMostOfAMachine * kTolerances * tolerance_mm)
    text += fmt::format("; if the machine can have errors of this size, give --tolerance {:g}",
                        std::ceil(10 * off_mm / kTolerances + 1) / 10);
  return text;
}

/// Compares the points with the nominal tool points: a list in another order would give a false result.
void check_distances(NominalTable& result, const ImportTable& points, const ListedRows& list,
                     const NominalList& nominal, const model::Machine& machine, double tolerance_mm) {
  constexpr double kLarge_mm = 20;  // more than a machine is wrong by, whatever tolerance the user states
  const ImportTable& table = result.table;
  const Eigen::VectorXd off = distances(table, machine);
  if (off.size() == 0) return;
  result.rms_mm = std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
  Eigen::Index worst = 0;
  const double limit_mm = kTolerances * tolerance_mm, off_mm = off.maxCoeff(&worst);
  if (off_mm <= limit_mm) {
    if (off_mm > kLarge_mm)
      if (const std::string other = other_counting(table, points, list, nominal, machine, kLarge_mm, off_mm);
          !other.empty())
        result.note += (result.note.empty() ? "" : ". ") + other;
    return;
  }
  std::string mend = other_unit(table, points, list, nominal, machine, tolerance_mm);
  if (mend.empty()) mend = other_unit_of_points(table, nominal, machine, tolerance_mm);
  if (mend.empty()) mend = other_counting(table, points, list, nominal, machine, limit_mm, off_mm);
  throw text::InputError(
      {table.file, table.line[static_cast<std::size_t>(worst)]}, "",
      fmt::format(
          "this point is {:.3g} mm from its nominal position after the best rigid motion of all points "
          "({}){}",
          off_mm, joined_by(result),
          mend.empty()
              ? what_to_check(machine, result.names.empty() && !result.by_distances, off_mm, tolerance_mm)
              : ". " + mend));
}

}  // namespace

double nominal_tolerance_mm(const model::Machine& machine) {
  // A third of the largest distance of a point: of a machine tool, and of a robot before its calibration.
  constexpr double kOfMachine_mm = 2, kOfRobot_mm = 5;
  const bool robot = std::all_of(machine.axes.begin(), machine.axes.end(),
                                 [](const model::Axis& axis) { return axis.rotary; });
  return robot ? kOfRobot_mm : kOfMachine_mm;
}

std::string joined_by(const NominalTable& table) {
  if (!table.names.empty()) return "joined by the names in " + table.names;
  return table.by_distances ? "joined by their order and the distances between them" : "joined by row number";
}

NominalTable with_nominal(const ImportTable& points, const NominalList& nominal,
                          const model::Machine& machine, double tolerance_mm) {
  ListedRows list = read_nominal_list(nominal, machine,
                                      [&](const std::string& axis) { return points.find(axis) == nullptr; });
  if (!list.open.axes.empty()) {
    const std::string units =
        asks_for_unit_of_angles(list) ? settle_units(points, list, machine, tolerance_mm) : "";
    refuse_open_axes(nominal, list, machine, units);
  }
  NominalTable result;
  result.note = list.note;
  const JoinedRows rows = rows_of_points(points, list, machine, tolerance_mm);
  result.names = rows.names;
  result.by_distances = rows.by_distances;
  std::vector<char> used(list.rows.size());
  for (const std::size_t row : rows.rows) used[row] = 1;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] == 0) result.unused_lines.push_back(list.place(i).line);
  result.table = joined(points, list, rows.rows, machine);
  result.list = all_positions(points, list, machine);
  result.rows = rows.rows;
  check_distances(result, points, list, nominal, machine, tolerance_mm);
  return result;
}

std::vector<ListedPosition> listed_positions(const NominalList& nominal, const model::Machine& machine,
                                             const std::vector<std::string>& axes) {
  const ListedRows list = read_nominal_list(nominal, machine, [&](const std::string& axis) {
    return std::find(axes.begin(), axes.end(), axis) != axes.end();
  });
  if (!list.open.axes.empty()) refuse_open_axes(nominal, list, machine, "");
  const std::size_t names = column_of_names(list, machine);
  std::vector<ListedPosition> points;
  for (std::size_t i = 0; i < list.rows.size(); ++i) {
    points.push_back({text::trimmed(list.cell(i, names)), {}});
    for (std::size_t other = 0; other < i; ++other)
      if (points[other].name == points[i].name)
        throw text::InputError(list.place(i), points[i].name, kPointTwice);
  }
  for (const model::Axis& axis : machine.axes) {
    if (std::find(axes.begin(), axes.end(), axis.name) == axes.end()) continue;
    const std::size_t k = column_of_axis(list, axis);
    const double factor = format::find_unit(list.reading.columns[k].unit)->factor;
    for (std::size_t i = 0; i < list.rows.size(); ++i)
      points[i].values.push_back(*text::parse_number(position_cell(list, i, k, axis)) * factor);
  }
  return points;
}

}  // namespace vernier::importer
