// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement_names.h"

#include "tools/format/columns.h"

namespace vernier::model {
namespace {

bool is_correction(const Machine& machine, std::string_view name) {
  const std::string_view prefix = format::entry_of(format::AxisQuantity::kCorrection).prefix;
  return name.starts_with(prefix) && machine.find_axis(std::string(name.substr(prefix.size()))).has_value();
}

}  // namespace

bool is_no_axis_name(const Machine& machine, std::string_view name) {
  return format::find_column(name) != nullptr || is_correction(machine, name);
}

bool is_no_input_name(const Machine& machine, std::string_view name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return (column != nullptr && !column->later) || is_correction(machine, name);
}

std::string set_of_axis(const Axis& axis) {
  return "--set \"" + format::axis_heading(format::AxisQuantity::kPosition, axis.name, axis.rotary) +
         "=POSITION\"";
}

}  // namespace vernier::model
