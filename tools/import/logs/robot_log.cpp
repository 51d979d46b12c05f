// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/robot_log.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/logs/nominal_points.h"
#include "tools/import/logs/open_axes.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using LogColumns = std::vector<RobotLog::Column>;

/// Columns x, y, z in any letters that are no axis of the machine and no reading: the point that the control
/// shows, in mm without a unit in the heading. Empty without all three.
LogColumns point_of_control(const model::Machine& machine, const SheetReading& reading) {
  LogColumns point;
  for (const char* const axis : {"X", "Y", "Z"})
    for (std::size_t k = 0; k < reading.columns.size(); ++k) {
      const sheet::Heading& heading = reading.table.headings[k];
      const bool reads = !heading.unit.empty() && reading.columns[k].name == reading_of(axis);
      if (text::in_small_letters(heading.name) != reading_of(axis) || reads ||
          reading.columns[k].why != "by its heading" || machine.find_axis(heading.name))
        continue;
      point.push_back({k, *reading_of(axis), heading.unit.empty() ? "mm" : heading.unit});
      break;
    }
  return point.size() == std::size(format::columns::kPoint) ? point : LogColumns{};
}

/// Largest distance of the point from the tool points of the nominal machine at these joints, mm. No value:
/// the columns are not those of all axes, or a cell is no number.
std::optional<double> distance_from_nominal_mm(const model::Machine& machine, const SheetReading& reading,
                                               const LogColumns& columns) {
  ImportTable table{reading.sheet.file, {}, {}};
  for (std::size_t row = reading.table.first_data; row < reading.sheet.rows.size(); ++row)
    if (!sheet::is_blank(reading.sheet.rows[row])) table.line.push_back(row);
  const auto add = [&](const std::string& name, const std::string& unit, std::size_t column) {
    ImportTable::Column made{name, unit, {}};
    for (const std::size_t row : table.line) {
      const auto value = sheet::number_at(reading.sheet, row, column);
      if (value) made.cells.push_back(text::number_text(*value));
    }
    if (made.cells.size() == table.line.size()) table.columns.push_back(std::move(made));
  };
  for (const RobotLog::Column& one : columns)
    add(one.name, one.unit.empty() ? reading.columns[one.column].unit : one.unit, one.column);
  for (const model::Axis& axis : machine.axes)
    if (table.find(axis.name) == nullptr) return std::nullopt;
  const Eigen::VectorXd off = distances_from_nominal(table, machine, ToolPlace::kUnknown);
  return off.size() == 0 ? std::nullopt : std::optional(off.maxCoeff());
}

/// True if most axes of the machine turn: a robot's joints.
bool is_robot(const model::Machine& machine) {
  constexpr std::ptrdiff_t kFewestJoints = 2;
  return std::count_if(machine.axes.begin(), machine.axes.end(),
                       [](const model::Axis& axis) { return axis.rotary; }) >= kFewestJoints;
}

/// True if a column is a measured coordinate by its own name.
bool has_coordinate(const SheetReading& reading) {
  return std::any_of(reading.columns.begin(), reading.columns.end(), [](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn &&
           std::find(std::begin(format::columns::kPoint), std::end(format::columns::kPoint), one.name) !=
               std::end(format::columns::kPoint);
  });
}

/// True if a column of numbers is neither one of the joints nor an axis of the machine, and does not count
/// the rows.
bool has_other_numbers(const model::Machine& machine, const SheetReading& reading, const LogColumns& joints) {
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    if (column.use == SheetColumn::Use::kLeft || column.words || is_label(column.name) ||
        machine.find_axis(column.name) || heads_counting(reading.table.headings[k].text) ||
        std::any_of(joints.begin(), joints.end(), [&](const auto& one) { return one.column == k; }))
      continue;
    return true;
  }
  return false;
}

}  // namespace

std::optional<RobotLog> robot_log(const model::Machine& machine, const SheetReading& reading) {
  // More than the last digits of a log, and less than the errors of any robot.
  constexpr double kComputed_mm = 0.05;
  if (!is_robot(machine)) return std::nullopt;
  const bool named = open_axes(machine, reading).axes.empty();
  const LogColumns point = point_of_control(machine, reading);
  if (named && has_coordinate(reading)) return std::nullopt;
  RobotLog log;
  bool sure = true, units = true;
  const OpenAxes open = named ? OpenAxes{} : open_axes_without_units(machine, reading);
  if (!open.complete()) return std::nullopt;
  if (!named) {
    sure = open.found.sure;
    log.joints = open.words();
  }
  for (const model::Axis& axis : machine.axes) {
    const auto pair = std::find_if(open.found.pairs.begin(), open.found.pairs.end(),
                                   [&](const auto& one) { return open.axes[one.axis].name == axis.name; });
    if (pair == open.found.pairs.end()) {
      for (std::size_t k = 0; k < reading.columns.size(); ++k)
        if (reading.columns[k].name == axis.name) log.columns.push_back({k, axis.name, ""});
      continue;
    }
    const FreeColumn& free = open.columns[pair->column];
    log.columns.push_back({open.at[pair->column], axis.name, free.unit.empty() ? free.assumed : ""});
    units = units && !free.unit.empty();
  }
  // Beside joints with their units, the option --unit is that of the point.
  if (units && !point.empty() && !reading.wishes.unit.empty()) return std::nullopt;
  if (point.empty() && has_other_numbers(machine, reading, log.columns)) return std::nullopt;
  log.columns.insert(log.columns.end(), point.begin(), point.end());
  bool point_units = true;
  for (const RobotLog::Column& one : point) {
    const sheet::Heading& heading = reading.table.headings[one.column];
    point_units = point_units && !heading.unit.empty();
    log.point.push_back(heading.unit.empty() ? fmt::format("{}[{}]={}", one.name, one.unit, heading.text)
                                             : fmt::format("{}={}", one.name, heading.text));
  }
  log.missing = fmt::format("{}{}",
                            point.empty() ? "the table has the positions of the axes and no reading"
                            : point_units ? "the point of the table is no reading by its headings"
                                          : "the columns of the point have no unit",
                            sure ? "" : ", and no column has the name of an axis of the machine");
  log.condition = point_units ? "its unit is that of the headings" : "the point is in mm";
  if (!sure) log.condition += ", and the joints are the axes in the order of the machine file";
  if (!units)
    log.condition += std::string(sure ? ", and the joints are" : " and") + " in the units of this assignment";
  const std::optional<double> off = distance_from_nominal_mm(machine, reading, log.columns);
  if (off && *off < kComputed_mm) log.computed_mm = off;
  return log;
}

std::string why_not_read(const RobotLog& log, const std::string& with_points) {
  if (log.point.empty())
    return fmt::format("{}. If an instrument measured points at these positions, {}", log.missing,
                       with_points);
  if (log.computed_mm)
    return fmt::format(
        "{}. The point agrees with the positions of the nominal machine at these joints within {:.2g} mm: "
        "the "
        "control probably computed it from the joints, and it is no measurement. If an instrument measured "
        "points at these positions, {}; if an instrument measured the point of this file, {}",
        log.missing, *log.computed_mm, with_points, log.condition);
  return fmt::format(
      "{}. If an instrument measured this point (a position that the control shows is computed from the "
      "joints, and is no measurement), {}",
      log.missing, log.condition);
}

}  // namespace vernier::importer
