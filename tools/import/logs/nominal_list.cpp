// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/nominal_list.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/reading/sheet_import.h"
#include "tools/import/words/joint_names.h"
#include "tools/maths/alignment.h"
#include "tools/model/chain/chain.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr const char* kPointTwice = "the list of nominal positions has this point twice";

/// The rows of a list of nominal positions.
struct List {
  SheetReading reading;
  std::vector<std::size_t> rows;  // rows that are not blank
  std::string note;               // what was assumed; empty: nothing

  const std::string& cell(std::size_t i, std::size_t column) const {
    return reading.sheet.rows[rows[i]][column];
  }
  text::Place place(std::size_t i) const { return {reading.sheet.file, reading.sheet.line[rows[i]]}; }
  text::Place heading() const { return {reading.sheet.file, reading.sheet.line[reading.table.heading_row]}; }
};

/// True if the numbers of a column without a unit can only be degrees: one of them is more than a turn in
/// radians.
bool must_be_degrees(const List& list, std::size_t column) {
  constexpr double kTurn_rad = 6.2832;  // a whole turn, rounded up
  double most = 0;
  for (std::size_t i = 0; i < list.rows.size(); ++i) {
    const auto number = sheet::number_at(list.reading.sheet, list.rows[i], column);
    if (!number) return false;
    most = std::max(most, std::abs(*number));
  }
  return most > kTurn_rad;
}

/// Gives the columns of a robot's joints under their usual names (A1, J1, q1) the names of the axes, as the
/// import of a table does. Joints of which no heading has a unit are in degrees if one of them must be, with
/// a note: the distances of the points show a mistake.
void take_joints(List& list, const model::Machine& machine) {
  SheetReading& reading = list.reading;
  std::vector<MissingAxis> axes;
  for (const model::Axis& axis : machine.axes)
    if (std::none_of(reading.columns.begin(), reading.columns.end(), [&](const SheetColumn& one) {
          return one.name == axis.name && !(axis.rotary && one.unit.empty());
        }))
      axes.push_back({axis.name, axis.rotary});
  std::vector<FreeColumn> columns, in_degrees;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    const auto axis = machine.find_axis(column.name);
    if (column.use != SheetColumn::Use::kColumn || column.words || (axis && !column.unit.empty())) continue;
    columns.push_back({reading.table.headings[k].text, reading.table.headings[k].name, column.unit});
    in_degrees.push_back(columns.back());
    if (column.unit.empty()) in_degrees.back().unit = "deg";
    at.push_back(k);
  }
  JointColumns found = joint_columns(axes, columns);
  const bool states_no_unit = std::all_of(columns.begin(), columns.end(), [](const FreeColumn& one) {
    return one.unit.empty() || format::find_unit(one.unit)->dimension != format::Dimension::kAngle;
  });
  if (!found.sure && states_no_unit) {
    found = joint_columns(axes, in_degrees);
    if (!found.sure || std::none_of(found.pairs.begin(), found.pairs.end(),
                                    [&](const auto& pair) { return must_be_degrees(list, at[pair.column]); }))
      return;
    for (const JointColumns::Pair& pair : found.pairs)
      if (reading.columns[at[pair.column]].unit.empty()) reading.columns[at[pair.column]].unit = "deg";
    list.note = fmt::format("{}: the columns of the joints ({} ...) have no unit: they are read in degrees",
                            reading.sheet.file, columns[found.pairs.front().column].heading);
  }
  if (!found.sure) return;
  for (const JointColumns::Pair& pair : found.pairs)
    reading.columns[at[pair.column]].name = axes[pair.axis].name;
}

List read_list(const std::string& bytes, const std::string& file, const model::Machine& machine) {
  SheetWords words;
  for (const model::Axis& axis : machine.axes) words.axes.push_back(axis.name);
  List list{read_as_sheet(bytes, file, words), {}, {}};
  const sheet::Sheet& sheet = list.reading.sheet;
  for (std::size_t row = list.reading.table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) list.rows.push_back(row);
  take_joints(list, machine);
  return list;
}

/// The column of an axis in the list.
std::size_t column_of_axis(const List& list, const model::Axis& axis) {
  const std::vector<SheetColumn>& columns = list.reading.columns;
  const std::string example = format::axis_heading(format::AxisQuantity::kPosition, axis.name, axis.rotary);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || columns[k].name != axis.name) continue;
    if (columns[k].unit.empty())
      throw text::InputError(list.heading(), list.reading.table.headings[k].text,
                             "this heading has no unit: write it into the list, for example " + example);
    return k;
  }
  throw text::InputError(
      list.heading(), axis.name,
      "the list of nominal positions has no column for this axis: write a heading such as " + example +
          " above the column, or add the column");
}

/// The number in a cell of the list, with a decimal point.
std::string position_cell(const List& list, std::size_t i, std::size_t column, const model::Axis& axis) {
  const std::string& cell = list.cell(i, column);
  const auto number = sheet::plain_number(cell, list.reading.sheet.decimal_comma);
  if (!number)
    throw text::InputError(list.place(i), cell, "not a number, for the nominal position of " + axis.name);
  return *number;
}

/// The column with the names of the points: the first one that is no axis and has a cell in each row.
std::size_t column_of_names(const List& list, const model::Machine& machine) {
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

/// Row of the list for each point, by a column of names in both; empty: there is no such column.
std::vector<std::size_t> rows_by_name(const ImportTable& points, const List& list, std::string& names) {
  for (const ImportTable::Column& column : points.columns) {
    if (!column.unit.empty() || format::find_column(column.name) != nullptr) continue;
    for (std::size_t k = 0; k < list.reading.columns.size(); ++k) {
      const sheet::Heading& heading = list.reading.table.headings[k];
      const bool same = text::in_small_letters(heading.name) == text::in_small_letters(column.name);
      std::vector<std::string> own;
      for (std::size_t i = 0; i < list.rows.size(); ++i) own.push_back(list.cell(i, k));
      // Numbers join only under the same heading; words may have another one in each file.
      if (!same && !(has_words(own) && has_words(column.cells))) continue;
      std::map<std::string, std::vector<std::size_t>> index;
      for (std::size_t i = 0; i < own.size(); ++i) index[key_of(own[i])].push_back(i);
      std::vector<std::size_t> rows;
      std::size_t missing = column.cells.size(), found = 0;
      for (std::size_t i = 0; i < column.cells.size(); ++i) {
        const auto at = index.find(key_of(column.cells[i]));
        if (at == index.end()) {
          missing = std::min(missing, i);
          continue;
        }
        if (at->second.size() > 1)
          throw text::InputError(list.place(at->second[1]), own[at->second[1]], kPointTwice);
        rows.push_back(at->second.front());
        ++found;
      }
      if (missing == column.cells.size()) {
        names = column.name;
        return rows;
      }
      if (same || 2 * found > column.cells.size())
        throw text::InputError({points.file, points.line[missing]}, column.cells[missing],
                               fmt::format("the list of nominal positions ({}) has no point of this name",
                                           list.reading.sheet.file));
    }
  }
  return {};
}

std::vector<std::size_t> rows_by_number(const ImportTable& points, const List& list) {
  if (points.line.size() != list.rows.size())
    throw text::InputError(
        list.heading(), "",
        fmt::format(
            "{} has {} points, this list has {} positions, and no column of names joins them: read the "
            "names of the points too, for example --column 1=point",
            points.file, points.line.size(), list.rows.size()));
  std::vector<std::size_t> rows(list.rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
  return rows;
}

/// Positions of a reflector at an unknown place on the tool: the place in the frame of the tool and the rigid
/// motion that agree best with the points `to`, each found for the other in turn.
Eigen::Matrix3Xd reflector_positions(const model::Poses& nominal, const Eigen::Matrix3Xd& to) {
  constexpr int kMostTurns = 500;  // each reduces the difference by the spread of the orientations
  constexpr double kSettled_mm = 1e-4;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd from = nominal.position;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const maths::RigidMotion motion = maths::align(from, to);
    Eigen::Vector3d next = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < to.cols(); ++i)
      next += nominal.rotation[static_cast<std::size_t>(i)].transpose() *
              (motion.rotation.transpose() * (to.col(i) - motion.translation) - nominal.position.col(i));
    next /= static_cast<double>(to.cols());
    const bool settled = (next - place).norm() < kSettled_mm;
    place = next;
    for (Eigen::Index i = 0; i < to.cols(); ++i)
      from.col(i) = nominal.position.col(i) + nominal.rotation[static_cast<std::size_t>(i)] * place;
    if (settled) break;
  }
  return from;
}

/// Compares the points with the nominal tool points: a list in another order would give a false result.
void check_distances(NominalTable& result, const model::Machine& machine, double tolerance_mm) {
  const ImportTable& table = result.table;
  for (const char* name : format::columns::kPoint) {
    const auto* const column = table.find(name);
    if (column == nullptr) return;
    if (std::any_of(column->cells.begin(), column->cells.end(),
                    [](const auto& cell) { return cell.empty(); }))
      return;
  }
  const auto count = static_cast<Eigen::Index>(table.line.size());
  model::States states = model::make_states(table.line.size(), machine);
  model::make_one_run(states, "list");
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::vector<double> values = table.numbers(machine.axes[a].name);
    states.axis[a] = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
  }
  const model::Poses nominal = model::forward(model::nominal_machine(machine), states);
  Eigen::Matrix3Xd to(3, count);
  Eigen::Index row = 0;
  for (const char* name : format::columns::kPoint) {
    const std::vector<double> values = table.numbers(name);
    to.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), count);
  }
  if (!maths::fixes_motion(nominal.position)) return;
  const Eigen::Matrix3Xd from =
      machine.tool_shifts.empty() ? nominal.position : reflector_positions(nominal, to);
  const Eigen::VectorXd off = maths::aligned_error(maths::align(from, to), from, to).colwise().norm();
  result.rms_mm = std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
  constexpr double kBeyond = 3;  // tolerances, as in pair_points
  Eigen::Index worst = 0;
  if (off.maxCoeff(&worst) <= kBeyond * tolerance_mm) return;
  throw text::InputError(
      {table.file, table.line[static_cast<std::size_t>(worst)]}, "",
      fmt::format(
          "this point is {:.3g} mm from its nominal position after the best rigid motion of all points "
          "({}): check the order and the names of both lists{}, or give a larger --tolerance",
          off[worst],
          result.names.empty() ? "joined by row number" : "joined by the names in " + result.names,
          machine.tool_shifts.empty()
              ? "; if the points are those of a reflector at an unknown place on the tool, declare it in the "
                "machine file (vernier set MACHINE --reflector)"
              : ""));
}

}  // namespace

NominalTable with_nominal(const ImportTable& points, const std::string& bytes, const std::string& file,
                          const model::Machine& machine, double tolerance_mm) {
  const List list = read_list(bytes, file, machine);
  NominalTable result;
  result.note = list.note;
  std::vector<std::size_t> rows = rows_by_name(points, list, result.names);
  if (result.names.empty()) rows = rows_by_number(points, list);
  std::vector<std::size_t> used = rows;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  result.unused = list.rows.size() - used.size();
  result.table = {points.file, {}, points.line};
  for (const model::Axis& axis : machine.axes) {
    if (points.find(axis.name) != nullptr) continue;
    const std::size_t k = column_of_axis(list, axis);
    ImportTable::Column column{axis.name, list.reading.columns[k].unit, {}};
    for (const std::size_t i : rows) {
      column.cells.push_back(position_cell(list, i, k, axis));
    }
    result.table.columns.push_back(std::move(column));
  }
  result.table.columns.insert(result.table.columns.end(), points.columns.begin(), points.columns.end());
  check_distances(result, machine, tolerance_mm);
  return result;
}

std::vector<ListedPosition> listed_positions(const std::string& bytes, const std::string& file,
                                             const model::Machine& machine,
                                             const std::vector<std::string>& axes) {
  const List list = read_list(bytes, file, machine);
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
