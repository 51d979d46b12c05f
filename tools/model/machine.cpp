// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine.h"

#include <algorithm>

#include "tools/format/columns.h"
#include "tools/text/numbers.h"

namespace vernier::model {
namespace {

namespace columns = format::columns;
using format::AxisQuantity;

template <class List>
std::optional<std::size_t> find_named(const List& list, std::string_view name) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return i;
  return std::nullopt;
}

constexpr std::pair<AxisQuantity, SymbolKind> kAxisSymbols[] = {
    {AxisQuantity::kSpeed, SymbolKind::kVelocity},
    {AxisQuantity::kAcceleration, SymbolKind::kAcceleration},
    {AxisQuantity::kSense, SymbolKind::kDirection},
    {AxisQuantity::kSince, SymbolKind::kSince}};

/// Names that the axes define: v a dir since, and the table values l..x to r..z.
Symbol resolve_derived(const Machine& machine, std::string_view name) {
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const std::string& axis_name = machine.axes[axis].name;
    for (const auto& [quantity, kind] : kAxisSymbols)
      if (name == format::axis_column(quantity, axis_name)) return {kind, axis};
    if (name.size() != axis_name.size() + 2 || name.substr(1, axis_name.size()) != axis_name) continue;
    const char last = name.back();
    if ((name.front() == 'l' || name.front() == 'r') && last >= 'x' && last <= 'z')
      return {SymbolKind::kTableValue,
              axis * 6 + (name.front() == 'r' ? 3U : 0U) + static_cast<std::size_t>(last - 'x')};
  }
  return {};
}

Symbol resolve_fixed(std::string_view name) {
  if (name == columns::kTime) return {SymbolKind::kTime, 0};
  if (name == columns::kFeed) return {SymbolKind::kFeed, 0};
  if (name == columns::kCurvature) return {SymbolKind::kCurvature, 0};
  if (name == columns::kVisit) return {SymbolKind::kVisit, 0};
  for (std::size_t k = 0; k < columns::kNormal.size(); ++k)
    if (name == columns::kNormal[k]) return {SymbolKind::kNormal, k};
  return {};
}

ExprPtr resolve(const Machine& machine, const ExprPtr& expr) {
  auto node = std::make_shared<Expr>(*expr);
  if (node->op == Op::kSymbol) {
    node->symbol = resolve_name(machine, node->name);
    if (node->symbol.kind == SymbolKind::kUnresolved) throw ExpressionError(0, node->name, "unknown name");
  }
  for (ExprPtr& arg : node->args) arg = resolve(machine, arg);
  return node;
}

}  // namespace

std::optional<InputRole> input_role_named(std::string_view name) {
  const auto known = std::find(kInputRoleNames.begin() + 1, kInputRoleNames.end(), name);
  if (known == kInputRoleNames.end()) return std::nullopt;
  return static_cast<InputRole>(known - kInputRoleNames.begin());
}

std::optional<std::size_t> Machine::find_static(std::string_view n) const { return find_named(statics, n); }
std::optional<std::size_t> Machine::find_axis(std::string_view n) const { return find_named(axes, n); }
std::optional<std::size_t> Machine::find_input(std::string_view n) const { return find_named(inputs, n); }

const Table* Machine::table_of(std::size_t axis) const {
  for (const Table& table : tables)
    if (table.axis == axis) return &table;
  return nullptr;
}

std::optional<std::array<double, 2>> work_range(const Machine& machine, std::size_t axis) {
  for (const WorkRange& range : machine.volume)
    if (range.axis == axis) return std::array{range.min, range.max};
  const Axis& item = machine.axes[axis];
  if (item.min && item.max) return std::array{*item.min, *item.max};
  return std::nullopt;
}

Machine with_tool(const Machine& machine, const std::array<double, 3>& point) {
  Machine longer = machine;
  Transform shift;
  shift.n = machine.tool.empty() ? 1 : machine.tool.back().n + 1;
  for (std::size_t i = 0; i < shift.dof_count(); ++i) {
    shift.text[i] = i < 3 ? text::number_text(point[i]) : "0";
    shift.dof[i] = parse_expression_for(machine, shift.text[i]);
  }
  longer.tool.push_back(std::move(shift));
  return longer;
}

Symbol resolve_name(const Machine& machine, std::string_view name) {
  if (const auto i = machine.find_static(name)) return {SymbolKind::kStatic, *i};
  if (const auto i = machine.find_axis(name)) return {SymbolKind::kAxis, *i};
  if (const auto i = machine.find_input(name)) return {SymbolKind::kInput, *i};
  const Symbol fixed = resolve_fixed(name);
  return fixed.kind != SymbolKind::kUnresolved ? fixed : resolve_derived(machine, name);
}

ExprPtr parse_expression_for(const Machine& machine, std::string_view text) {
  return resolve(machine, parse_expression(text));
}

std::string symbol_name(const Machine& machine, const Symbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::kStatic:
      return machine.statics[symbol.index].name;
    case SymbolKind::kAxis:
      return machine.axes[symbol.index].name;
    case SymbolKind::kInput:
      return machine.inputs[symbol.index].name;
    case SymbolKind::kTableValue: {
      const std::size_t column = symbol.index % 6;
      return (column < 3 ? "l" : "r") + machine.axes[symbol.index / 6].name + "xyz"[column % 3];
    }
    case SymbolKind::kVelocity:
      return format::axis_column(AxisQuantity::kSpeed, machine.axes[symbol.index].name);
    case SymbolKind::kAcceleration:
      return format::axis_column(AxisQuantity::kAcceleration, machine.axes[symbol.index].name);
    case SymbolKind::kDirection:
      return format::axis_column(AxisQuantity::kSense, machine.axes[symbol.index].name);
    case SymbolKind::kSince:
      return format::axis_column(AxisQuantity::kSince, machine.axes[symbol.index].name);
    case SymbolKind::kFeed:
      return columns::kFeed;
    case SymbolKind::kCurvature:
      return columns::kCurvature;
    case SymbolKind::kNormal:
      return columns::kNormal[symbol.index];
    case SymbolKind::kTime:
      return columns::kTime;
    case SymbolKind::kVisit:
      return columns::kVisit;
    case SymbolKind::kUnresolved:
      break;
  }
  return {};
}

std::string symbol_unit(const Machine& machine, const Symbol& symbol) {
  const auto axis_unit = [&](AxisQuantity quantity) -> std::string {
    return format::unit_of(quantity, machine.axes[symbol.index].rotary);
  };
  switch (symbol.kind) {
    case SymbolKind::kStatic:
      return machine.statics[symbol.index].unit;
    case SymbolKind::kAxis:
      return axis_unit(AxisQuantity::kPosition);
    case SymbolKind::kSince:
      return axis_unit(AxisQuantity::kSince);
    case SymbolKind::kInput:
      return machine.inputs[symbol.index].unit;
    case SymbolKind::kTableValue:
      return symbol.index % 6 < 3 ? "mm" : "deg";
    case SymbolKind::kVelocity:
      return axis_unit(AxisQuantity::kSpeed);
    case SymbolKind::kAcceleration:
      return axis_unit(AxisQuantity::kAcceleration);
    case SymbolKind::kFeed:
      return format::column_unit(columns::kFeed);
    case SymbolKind::kCurvature:
      return format::column_unit(columns::kCurvature);
    case SymbolKind::kTime:
      return format::column_unit(columns::kTime);
    case SymbolKind::kDirection:
    case SymbolKind::kNormal:
    case SymbolKind::kVisit:
    case SymbolKind::kUnresolved:
      break;
  }
  return {};
}

Machine nominal_machine(const Machine& machine) {
  Machine nominal = machine;
  for (Static& item : nominal.statics) item.value = item.nominal.value_or(item.value);
  for (Axis& axis : nominal.axes) axis.scale_factor = 0;
  for (Table& table : nominal.tables)
    for (Station& station : table.stations) station.value.fill(0);
  nominal.base_shifts.clear();
  nominal.tool_shifts.clear();
  return nominal;
}

}  // namespace vernier::model
