// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/values.h"

namespace vernier::workbench {

model::ParameterSet all_parameters(const model::Machine& machine) {
  // A run that no BaseShift names uses the rows of the plain one.
  std::vector<std::string> runs = {""};
  for (const model::BaseShift& shift : machine.base_shifts)
    if (shift.run) runs.push_back(*shift.run);
  return model::ParameterSet(machine, runs);
}

void set_values(model::Machine& machine, const std::map<std::string, double>& values) {
  const model::ParameterSet parameters = all_parameters(machine);
  Eigen::VectorXd point = parameters.get(machine);
  std::map<std::string, double> left = values;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto found = left.find(parameters[i].name);
    if (found == left.end()) continue;
    point[static_cast<Eigen::Index>(i)] = found->second;
    left.erase(found);
  }
  parameters.set(machine, point);
  for (const auto& [name, value] : left) {
    const auto found = machine.find_static(name);
    if (!found) throw text::InputError("\"" + name + "\": no parameter of " + machine.file);
    machine.statics[*found].value = value;
  }
}

}  // namespace vernier::workbench
