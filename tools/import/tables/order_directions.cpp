// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/order_directions.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/order/motion_directions.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::importer {
namespace {

/// Largest change of the display of an axis at rest, mm or deg: ten times the last digit that a control
/// usually shows. Measured backlash needs longer motions.
constexpr double kStill = 0.01;

/// The positions of a column in mm or deg; NaN for an empty cell.
std::vector<double> positions_of(const ImportTable::Column& column) {
  const auto unit = format::find_unit(column.unit);
  const double factor = column.unit.empty() || !unit ? 1 : unit->factor;
  std::vector<double> positions;
  for (const std::string& cell : column.cells) {
    const auto value = text::parse_number(cell);
    positions.push_back(value ? *value * factor : std::numeric_limits<double>::quiet_NaN());
  }
  return positions;
}

/// The name of the sequence of motions of each row: its run and its set-up.
std::vector<std::string> sequences_of(const ImportTable& table) {
  std::vector<std::string> names(table.line.size());
  for (const char* const label : {format::columns::kRun, format::columns::kSetup})
    if (const ImportTable::Column* const column = table.find(label))
      for (std::size_t row = 0; row < names.size(); ++row) names[row] += column->cells[row] + ";";
  return names;
}

/// The sequence of each row of a list by its points. A row without a point continues the sequence before it.
/// Empty: one sequence, because a position has points of several runs.
std::vector<std::string> sequences_of_list(const ImportTable& table, std::size_t count,
                                           const std::vector<std::size_t>& rows) {
  const std::vector<std::string> own = sequences_of(table);
  std::vector<std::string> names(count);
  std::vector<char> stated(count, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (stated[rows[i]] != 0 && names[rows[i]] != own[i]) return std::vector<std::string>(count);
    names[rows[i]] = own[i];
    stated[rows[i]] = 1;
  }
  for (std::size_t i = 1; i < count; ++i)
    if (stated[i] == 0 && stated[i - 1] != 0) names[i] = names[i - 1], stated[i] = 1;
  for (std::size_t i = count; i-- > 1;)
    if (stated[i - 1] == 0) names[i - 1] = names[i], stated[i - 1] = 1;
  return names;
}

}  // namespace

std::vector<std::string> add_directions_of_list(ImportTable& table, ImportTable list,
                                                const std::vector<std::size_t>& rows,
                                                const std::function<bool(const std::string&)>& is_axis) {
  // A column of directions of the points is not changed: as if the list had it.
  const std::size_t count = list.line.size();
  for (const ImportTable::Column& column : table.columns)
    if (const std::string name = format::axis_column(format::AxisQuantity::kSense, column.name);
        list.find(column.name) != nullptr && table.find(name) != nullptr)
      list.columns.push_back({name, "", std::vector<std::string>(count)});
  if (list.find(format::columns::kRun) == nullptr)
    list.columns.push_back({format::columns::kRun, "", sequences_of_list(table, count, rows)});
  std::vector<std::string> names = add_directions_from_order(list, is_axis);
  for (const std::string& name : names) {
    ImportTable::Column added{name, "", {}};
    const ImportTable::Column& column = *list.find(name);
    for (const std::size_t row : rows) added.cells.push_back(column.cells[row]);
    table.columns.push_back(std::move(added));
  }
  return names;
}

std::vector<std::string> add_directions_from_order(ImportTable& table,
                                                   const std::function<bool(const std::string&)>& is_axis) {
  const std::vector<std::string> sequences = sequences_of(table);
  std::vector<ImportTable::Column> made;
  bool stated = false;
  for (const ImportTable::Column& column : table.columns) {
    if (!is_axis(column.name)) continue;
    const std::string name = format::axis_column(format::AxisQuantity::kSense, column.name);
    if (table.find(name) != nullptr) {
      stated = true;
      continue;
    }
    const std::vector<int> directions = directions_of_last_motion(positions_of(column), sequences, kStill);
    if (std::all_of(directions.begin(), directions.end(), [](int one) { return one == 0; })) continue;
    ImportTable::Column added{name, "", {}};
    for (const int one : directions) added.cells.push_back(std::to_string(one));
    made.push_back(std::move(added));
  }
  if (made.empty())
    throw text::InputError(
        stated ? "--directions from-order: each axis that moves has a column of directions; omit the option"
               : "--directions from-order: no axis of the table moves from row to row of a run, so that the "
                 "order of the rows states no direction");
  std::vector<std::string> names;
  for (ImportTable::Column& one : made) {
    names.push_back(one.name);
    table.columns.push_back(std::move(one));
  }
  return names;
}

}  // namespace vernier::importer
