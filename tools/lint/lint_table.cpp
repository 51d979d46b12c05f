// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint_table.h"

#include <cctype>
#include <deque>

#include "tools/format/columns.h"

namespace vernier::lint {

std::string quoted_for_shell(const std::string& file) {
  return file.find_first_of(" '\"$()&;*?") == std::string::npos ? file : "'" + file + "'";
}

const LintColumn* LintTable::find(const std::string& name) const {
  for (const LintColumn& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

bool LintNames::is_reading(const LintTable& table, const LintColumn& column) const {
  if (column.name == format::columns::kOn && machine_ != nullptr && machine_->artefacts.empty()) return false;
  // Found columns outlive the call: the format looks at one header at a time.
  std::deque<format::CsvColumn> header;
  return format::is_reading({column.name, column.unit},
                            [&](std::string_view name) -> const format::CsvColumn* {
                              const LintColumn* const found = table.find(std::string(name));
                              if (found == nullptr || is_input(found->name)) return nullptr;
                              return &header.emplace_back(format::CsvColumn{found->name, found->unit});
                            });
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
std::optional<format::AxisColumnName> LintNames::of_axis(const std::string& name) const {
  return format::axis_column_named(name, [&](const std::string& axis) { return is_axis(axis); });
}

bool LintNames::is_of_axis(const std::string& name, format::AxisQuantity quantity) const {
  const auto column = of_axis(name);
  return column && column->quantity == quantity;
}

bool LintNames::lacks_artefact_of(const LintTable& table) const {
  return machine_ != nullptr && machine_->artefacts.empty() && table.find(format::columns::kOn) != nullptr;
}

std::string LintNames::needed_unit(const std::string& name) const {
  if (const auto column = of_axis(name)) return format::unit_of(column->quantity, is_rotary(column->axis));
  const format::ColumnGroup* const known = format::find_column(name);
  // With another unit a column of a later version is a person's own; u is a length or an angle.
  const bool any = known == nullptr || known->or_unit != nullptr || (known->later && !known->words);
  return any ? "?" : known->unit;
}

std::vector<std::string> LintNames::known() const {
  std::vector<std::string> names;
  for (const format::ColumnGroup& group : format::column_groups())
    names.insert(names.end(), group.list().begin(), group.list().end());
  if (machine_ == nullptr) return names;
  for (const model::Axis& axis : machine_->axes)
    for (const format::AxisColumnEntry& column : format::kAxisColumns)
      names.push_back(format::axis_column(column.quantity, axis.name));
  for (const model::Input& input : machine_->inputs) names.push_back(input.name);
  return names;
}

}  // namespace vernier::lint
