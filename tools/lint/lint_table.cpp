// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint_table.h"

#include <cctype>
#include <map>
#include <tuple>

namespace vernier::lint {

const std::set<std::string>& reading_names() {
  static const std::set<std::string> kNames = {"x", "y", "z", "rx", "ry", "rz", "length", "d"};
  return kNames;
}

std::string quoted_for_shell(const std::string& file) {
  return file.find_first_of(" '\"$()&;*?") == std::string::npos ? file : "'" + file + "'";
}

const LintColumn* LintTable::find(const std::string& name) const {
  for (const LintColumn& column : columns)
    if (column.name == name) return &column;
  return nullptr;
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
  static const std::map<std::string, std::string> kUnits = {
      {"x", "mm"},      {"y", "mm"},  {"z", "mm"},   {"rx", "deg"},    {"ry", "deg"},    {"rz", "deg"},
      {"length", "mm"}, {"d", "mm"},  {"cx", "mm"},  {"cy", "mm"},     {"cz", "mm"},     {"px", "mm"},
      {"py", "mm"},     {"pz", "mm"}, {"nx", ""},    {"ny", ""},       {"nz", ""},       {"t", "s"},
      {"run", ""},      {"role", ""}, {"visit", ""}, {"feed", "mm/s"}, {"curv", "1/mm"}, {"corrected", ""}};
  const auto found = kUnits.find(name);
  return found == kUnits.end() ? "?" : found->second;
}

std::vector<std::string> LintNames::known() const {
  std::vector<std::string> names = {"x",   "y",    "z",    "rx",   "ry", "rz",    "length",   "d",  "cx",
                                    "cy",  "cz",   "px",   "py",   "pz", "nx",    "ny",       "nz", "t",
                                    "run", "role", "feed", "curv", "u",  "visit", "corrected"};
  if (machine_ == nullptr) return names;
  for (const model::Axis& axis : machine_->axes)
    for (const char* prefix : {"", "dir", "since", "v", "a", "correction"})
      names.push_back(prefix + axis.name);
  for (const model::Input& input : machine_->inputs) names.push_back(input.name);
  return names;
}

}  // namespace vernier::lint
