// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint_table.h"

#include <cctype>
#include <tuple>

#include "tools/model/measurement_names.h"
#include "tools/text/units.h"

namespace vernier::lint {

std::string quoted_for_shell(const std::string& file) {
  return file.find_first_of(" '\"$()&;*?") == std::string::npos ? file : "'" + file + "'";
}

const LintColumn* LintTable::find(const std::string& name) const {
  for (const LintColumn& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

bool is_reading(const LintTable& table, const LintColumn& column) {
  const model::KnownColumn* const known = model::find_known_column(column.name);
  if (known == nullptr || !known->reading) return false;
  if (!known->since) return true;
  if (column.name == "distance") return table.find("from") != nullptr;
  const auto unit = text::find_unit(column.unit);
  if (column.name.front() == 'i') return unit && unit->dimension == text::Dimension::kAngle;
  return column.unit.empty() && table.find("ax") != nullptr && table.find("ay") != nullptr &&
         table.find("az") != nullptr;
}

bool LintNames::is_axis(const std::string& name) const {
  if (machine_ != nullptr) return machine_->find_axis(name).has_value();
  if (name.size() == 1) return std::string("XYZABCUVW").find(name) != std::string::npos;
  return name.size() == 2 && name[0] == 'J' && std::isdigit(static_cast<unsigned char>(name[1])) != 0;
}
bool LintNames::is_rotary(const std::string& name) const {
  if (machine_ != nullptr) return machine_->axes[*machine_->find_axis(name)].rotary;
  return std::string("ABCJ").find(name[0]) != std::string::npos;
}
std::string LintNames::axis_of(const std::string& name, const std::string& prefix) const {
  if (!name.starts_with(prefix) || name.size() == prefix.size()) return "";
  const std::string axis = name.substr(prefix.size());
  return is_axis(axis) ? axis : "";
}

std::string LintNames::needed_unit(const std::string& name) const {
  if (is_axis(name)) return is_rotary(name) ? "deg" : "mm";
  for (const auto& [prefix, length, angle] :
       {std::tuple("v", "mm/s", "deg/s"), std::tuple("a", "mm/s^2", "deg/s^2"),
        std::tuple("since", "mm", "deg"), std::tuple("correction", "mm", "deg")})
    if (const std::string axis = axis_of(name, prefix); !axis.empty())
      return is_rotary(axis) ? angle : length;
  if (!axis_of(name, "dir").empty()) return "";
  const model::KnownColumn* const known = model::find_known_column(name);
  // With another unit a word of a later version is a column of one's own; u is a length or an angle.
  const bool any = known == nullptr || name == "u" || (known->since && !known->label);
  return any ? "?" : known->unit;
}

std::vector<std::string> LintNames::known() const {
  std::vector<std::string> names;
  for (const model::KnownColumn& column : model::known_columns()) names.emplace_back(column.name);
  if (machine_ == nullptr) return names;
  for (const model::Axis& axis : machine_->axes)
    for (const char* prefix : {"", "dir", "since", "v", "a", "correction"})
      names.push_back(prefix + axis.name);
  for (const model::Input& input : machine_->inputs) names.push_back(input.name);
  return names;
}

}  // namespace vernier::lint
