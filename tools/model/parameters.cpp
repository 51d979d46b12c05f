// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/parameters.h"

#include <set>

namespace vernier::model {
namespace {

double& slot(Machine& machine, const Parameter& p) {
  switch (p.kind) {
    case ParameterKind::kStatic:
      return machine.statics[p.item].value;
    case ParameterKind::kScaleFactor:
      return machine.axes[p.item].scale_factor;
    case ParameterKind::kStation:
      return machine.tables[p.item].stations[p.station].value[p.column];
    case ParameterKind::kToolShift:
      return machine.tool_shifts[p.item].value[p.column];
    case ParameterKind::kBaseShift:
      break;
  }
  return machine.base_shifts[p.item].value[p.column];
}

std::optional<std::size_t> shift_of(const std::vector<BaseShift>& shifts, const std::string& run) {
  std::optional<std::size_t> plain;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    if (shifts[i].run == run) return i;
    if (!shifts[i].run) plain = i;
  }
  return plain;
}

/// "BaseShift", "ToolShift[s2]".
std::string name_of(ParameterKind kind, const BaseShift& shift) {
  const std::string word = kind == ParameterKind::kBaseShift ? "BaseShift" : "ToolShift";
  return shift.run ? word + "[" + *shift.run + "]" : word;
}

}  // namespace

std::optional<std::size_t> base_shift_of(const Machine& machine, const std::string& run) {
  return shift_of(machine.base_shifts, run);
}

std::optional<std::size_t> tool_shift_of(const Machine& machine, const std::string& run) {
  return shift_of(machine.tool_shifts, run);
}

std::vector<SetUpOfRow> set_ups_of(const Machine& machine, const std::vector<std::string>& names) {
  std::vector<SetUpOfRow> list;
  for (const std::string& name : names) {
    const auto base = base_shift_of(machine, name), tool = tool_shift_of(machine, name);
    list.push_back(
        {base ? &machine.base_shifts[*base] : nullptr, tool ? &machine.tool_shifts[*tool] : nullptr});
  }
  return list;
}

std::string without_station(std::string parameter) {
  if (!parameter.starts_with("table.")) return parameter;
  const auto open = parameter.find('['), close = parameter.find(']', open);
  if (open != std::string::npos && close != std::string::npos) parameter.erase(open, close - open + 1);
  return parameter;
}

std::vector<Freedom> freedoms_of(Machine& machine) {
  std::vector<Freedom> all;
  for (Static& item : machine.statics) all.emplace_back(ParameterKind::kStatic, item.name, item.hidden);
  for (Axis& axis : machine.axes)
    all.emplace_back(ParameterKind::kScaleFactor, "scalefactor." + axis.name, axis.scale_free);
  for (Table& table : machine.tables)
    for (std::size_t c = 0; c < 6; ++c)
      all.emplace_back(ParameterKind::kStation,
                       "table." + machine.axes[table.axis].name + "." + kSixDofNames[c], table.free[c]);
  for (BaseShift& shift : machine.base_shifts)
    all.emplace_back(ParameterKind::kBaseShift, name_of(ParameterKind::kBaseShift, shift), shift.hidden);
  for (BaseShift& shift : machine.tool_shifts)
    all.emplace_back(ParameterKind::kToolShift, name_of(ParameterKind::kToolShift, shift), shift.hidden);
  return all;
}

ParameterSet::ParameterSet(const Machine& machine, const std::vector<std::string>& runs) {
  for (std::size_t i = 0; i < machine.statics.size(); ++i)
    if (!machine.statics[i].hidden)
      list_.push_back({machine.statics[i].name, machine.statics[i].unit, ParameterKind::kStatic, i, 0, 0});
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].scale_free)
      list_.push_back({"scalefactor." + machine.axes[i].name, "", ParameterKind::kScaleFactor, i, 0, 0});
  for (std::size_t i = 0; i < machine.tables.size(); ++i) {
    const Table& table = machine.tables[i];
    const std::size_t count = table.stations.size() - (table.periodic ? 1 : 0);
    for (std::size_t s = 0; s < count; ++s)
      for (std::size_t c = 0; c < 6; ++c) {
        if (!table.free[c]) continue;
        list_.push_back({"table." + machine.axes[table.axis].name + "[" + table.stations[s].loc_text + "]." +
                             kSixDofNames[c],
                         c < 3 ? "mm" : "deg", ParameterKind::kStation, i, s, c});
      }
  }
  const auto add = [&](ParameterKind kind, const std::vector<BaseShift>& shifts) {
    std::set<std::size_t> used;
    for (const std::string& run : runs)
      if (const auto shift = shift_of(shifts, run)) used.insert(*shift);
    for (const std::size_t i : used)
      for (std::size_t c = 0; !shifts[i].hidden && c < 6; ++c)
        list_.push_back(
            {name_of(kind, shifts[i]) + "." + kSixDofNames[c], c < 3 ? "mm" : "deg", kind, i, 0, c});
  };
  add(ParameterKind::kBaseShift, machine.base_shifts);
  add(ParameterKind::kToolShift, machine.tool_shifts);
}

Eigen::VectorXd ParameterSet::get(const Machine& machine) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i)
    values[static_cast<Eigen::Index>(i)] = slot(const_cast<Machine&>(machine), list_[i]);
  return values;
}

void ParameterSet::set(Machine& machine, const Eigen::VectorXd& values) const {
  for (std::size_t i = 0; i < size(); ++i) slot(machine, list_[i]) = values[static_cast<Eigen::Index>(i)];
  for (Table& table : machine.tables)
    if (table.periodic)
      for (std::size_t c = 0; c < 6; ++c)
        if (table.free[c]) table.stations.back().value[c] = table.stations.front().value[c];
}

}  // namespace vernier::model
