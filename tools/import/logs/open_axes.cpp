// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/open_axes.h"

#include <algorithm>
#include <cmath>

#include "tools/import/columns/column_guess.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

using Use = SheetColumn::Use;

bool is_constant(const SheetReading& reading, const std::string& name) {
  return std::any_of(reading.wishes.constants.begin(), reading.wishes.constants.end(),
                     [&](const MappedColumn& one) { return one.name == name; });
}

/// A column of numbers whose meaning is only its heading.
bool is_free(const SheetColumn& column, const model::Machine& machine) {
  return column.use == Use::kColumn && !column.words && column.why == "by its heading" &&
         !is_known_name(column.name) && !is_sense(column.name) && !machine.find_input(column.name);
}

FreeColumn free_column(const SheetReading& reading, std::size_t k, const std::string& unit) {
  return {reading.table.headings[k].text, reading.table.headings[k].name, unit};
}

/// Index of the column of an axis by its name; the number of columns if no column has the name of the axis.
std::size_t column_named(const SheetReading& reading, const std::string& name) {
  const auto found = std::find_if(
      reading.columns.begin(), reading.columns.end(),
      [&](const SheetColumn& one) { return one.use == Use::kColumn && !one.words && one.name == name; });
  return static_cast<std::size_t>(found - reading.columns.begin());
}

template <class Is>
bool any_value(const SheetReading& reading, const std::vector<std::size_t>& columns, const Is& is) {
  return std::any_of(columns.begin(), columns.end(), [&](std::size_t k) {
    for (std::size_t row = reading.table.first_data; row < reading.sheet.rows.size(); ++row)
      if (const auto value = sheet::number_at(reading.sheet, row, k); value && is(*value)) return true;
    return false;
  });
}

/// Finds the axes of which no column has the name: the columns without units are tried as angles.
void find_others(OpenAxes& open) {
  OpenAxes rest;
  std::vector<std::size_t> axis_of, column_of;
  const auto taken = [&](const auto& same) {
    return std::any_of(open.found.pairs.begin(), open.found.pairs.end(), same);
  };
  for (std::size_t a = 0; a < open.axes.size(); ++a) {
    if (taken([&](const auto& pair) { return pair.axis == a; })) continue;
    rest.axes.push_back(open.axes[a]);
    axis_of.push_back(a);
  }
  for (std::size_t k = 0; k < open.columns.size(); ++k) {
    if (taken([&](const auto& pair) { return pair.column == k; })) continue;
    rest.columns.push_back(open.columns[k]);
    if (rest.columns.back().unit.empty()) rest.columns.back().unit = "deg";
    column_of.push_back(k);
  }
  const JointColumns found = joint_columns(rest.axes, rest.columns);
  if (!rest.axes.empty()) {
    open.found.sure = found.sure;
    open.found.why = found.why;
  }
  for (const JointColumns::Pair& pair : found.pairs)
    open.found.pairs.push_back({axis_of[pair.axis], column_of[pair.column]});
  std::sort(open.found.pairs.begin(), open.found.pairs.end(),
            [](const auto& one, const auto& other) { return one.axis < other.axis; });
}

}  // namespace

std::vector<std::string> OpenAxes::headings() const {
  std::vector<std::string> list;
  for (const auto& [axis, column] : found.pairs) list.push_back(columns[column].heading);
  return list;
}

std::vector<std::string> OpenAxes::words() const {
  std::vector<std::string> list;
  for (const auto& [axis, column] : found.pairs) list.push_back(column_word(axes[axis], columns[column]));
  return list;
}

OpenAxes open_axes(const model::Machine& machine, const SheetReading& reading) {
  OpenAxes open;
  for (const model::Axis& axis : machine.axes)
    if (column_named(reading, axis.name) == reading.columns.size() && !is_constant(reading, axis.name))
      open.axes.push_back({axis.name, axis.rotary});
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    if (!is_free(reading.columns[k], machine) || machine.find_axis(reading.columns[k].name)) continue;
    open.columns.push_back(free_column(reading, k, reading.columns[k].unit));
    open.at.push_back(k);
  }
  open.found = joint_columns(open.axes, open.columns);
  return open;
}

bool exceeds_a_turn(const SheetReading& reading, const std::vector<std::size_t>& columns) {
  constexpr double kTurn_rad = 6.2832;  // a whole turn, rounded up
  return any_value(reading, columns, [](double value) { return std::abs(value) > kTurn_rad; });
}

bool may_be_radians(const SheetReading& reading, const std::vector<std::size_t>& columns) {
  return !exceeds_a_turn(reading, columns) &&
         any_value(reading, columns, [](double value) { return value != std::round(value); });
}

OpenAxes open_axes_without_units(const model::Machine& machine, const SheetReading& reading) {
  OpenAxes open;
  open.found = {{}, true, "by their names"};
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const std::string& unit = reading.table.headings[k].unit;
    const bool named = machine.find_axis(reading.columns[k].name).has_value();
    if (!is_free(reading.columns[k], machine) || (named && !unit.empty())) continue;
    open.columns.push_back(free_column(reading, k, unit));
    open.at.push_back(k);
  }
  for (const model::Axis& axis : machine.axes) {
    if (is_constant(reading, axis.name)) continue;
    const std::size_t own = column_named(reading, axis.name);
    const auto free = std::find(open.at.begin(), open.at.end(), own);
    if (own < reading.columns.size() && free == open.at.end()) continue;  // a column with its unit
    open.axes.push_back({axis.name, axis.rotary});
    if (free != open.at.end())
      open.found.pairs.push_back({open.axes.size() - 1, static_cast<std::size_t>(free - open.at.begin())});
  }
  find_others(open);
  std::vector<std::size_t> bare;
  for (const auto& [axis, column] : open.found.pairs)
    if (open.axes[axis].rotary && open.columns[column].unit.empty()) bare.push_back(open.at[column]);
  const std::string unit = !bare.empty() && may_be_radians(reading, bare) ? "rad" : "deg";
  for (const auto& [axis, column] : open.found.pairs)
    open.columns[column].assumed = open.axes[axis].rotary ? unit : "mm";
  return open;
}

}  // namespace vernier::importer
