// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine.h"

#include <algorithm>

#include "tools/text/numbers.h"

namespace vernier::model {
namespace {

template <class List>
std::optional<std::size_t> find_named(const List& list, std::string_view name) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return i;
  return std::nullopt;
}

/// Names that the axes bring along: v a dir since, and the table values l..x to r..z.
Symbol resolve_derived(const Machine& machine, std::string_view name) {
  constexpr std::pair<std::string_view, SymbolKind> kPrefixes[] = {{"v", SymbolKind::kVelocity},
                                                                   {"a", SymbolKind::kAcceleration},
                                                                   {"dir", SymbolKind::kDirection},
                                                                   {"since", SymbolKind::kSince}};
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const std::string& axis_name = machine.axes[axis].name;
    for (const auto& [prefix, kind] : kPrefixes)
      if (name.size() == prefix.size() + axis_name.size() && name.starts_with(prefix) &&
          name.ends_with(axis_name))
        return {kind, axis};
    if (name.size() != axis_name.size() + 2 || name.substr(1, axis_name.size()) != axis_name) continue;
    const char last = name.back();
    if ((name.front() == 'l' || name.front() == 'r') && last >= 'x' && last <= 'z')
      return {SymbolKind::kTableValue,
              axis * 6 + (name.front() == 'r' ? 3U : 0U) + static_cast<std::size_t>(last - 'x')};
  }
  return {};
}

Symbol resolve_fixed(std::string_view name) {
  if (name == "t") return {SymbolKind::kTime, 0};
  if (name == "feed") return {SymbolKind::kFeed, 0};
  if (name == "curv") return {SymbolKind::kCurvature, 0};
  if (name == "visit") return {SymbolKind::kVisit, 0};
  if (name == "nx") return {SymbolKind::kNormal, 0};
  if (name == "ny") return {SymbolKind::kNormal, 1};
  if (name == "nz") return {SymbolKind::kNormal, 2};
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
      return "v" + machine.axes[symbol.index].name;
    case SymbolKind::kAcceleration:
      return "a" + machine.axes[symbol.index].name;
    case SymbolKind::kDirection:
      return "dir" + machine.axes[symbol.index].name;
    case SymbolKind::kSince:
      return "since" + machine.axes[symbol.index].name;
    case SymbolKind::kFeed:
      return "feed";
    case SymbolKind::kCurvature:
      return "curv";
    case SymbolKind::kNormal:
      return std::string("n") + "xyz"[symbol.index];
    case SymbolKind::kTime:
      return "t";
    case SymbolKind::kVisit:
      return "visit";
    case SymbolKind::kUnresolved:
      break;
  }
  return {};
}

std::string symbol_unit(const Machine& machine, const Symbol& symbol) {
  const auto axis_unit = [&](std::size_t axis) -> std::string {
    return machine.axes[axis].rotary ? "deg" : "mm";
  };
  switch (symbol.kind) {
    case SymbolKind::kStatic:
      return machine.statics[symbol.index].unit;
    case SymbolKind::kAxis:
    case SymbolKind::kSince:
      return axis_unit(symbol.index);
    case SymbolKind::kInput:
      return machine.inputs[symbol.index].unit;
    case SymbolKind::kTableValue:
      return symbol.index % 6 < 3 ? "mm" : "deg";
    case SymbolKind::kVelocity:
      return axis_unit(symbol.index) + "/s";
    case SymbolKind::kAcceleration:
      return axis_unit(symbol.index) + "/s^2";
    case SymbolKind::kFeed:
      return "mm/min";
    case SymbolKind::kCurvature:
      return "1/mm";
    case SymbolKind::kTime:
      return "s";
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
  return nominal;
}

}  // namespace vernier::model
