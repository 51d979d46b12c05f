// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/undetermined_joints.h"

#include <algorithm>

#include "tools/model/expression.h"
#include "tools/model/fit_record.h"
#include "tools/model/parameters.h"

namespace vernier::exchange {
namespace {

bool contains(const model::Transform& transform, const std::string& parameter) {
  for (std::size_t dof = 0; dof < transform.dof_count(); ++dof)
    if (model::any_node(*transform.dof[dof], [&](const model::Expr& node) {
          return node.op == model::Op::kSymbol && model::without_station(parameter) == node.name;
        }))
      return true;
  return false;
}

}  // namespace

std::vector<UndeterminedJoint> undetermined_joints(const model::Machine& machine,
                                                   const std::vector<std::size_t>& axis_of) {
  if (!machine.fitted) return {};
  const model::FitRecord& fitted = *machine.fitted;
  std::vector<std::string> open;
  for (std::size_t i = 0; i < std::min(fitted.parameters.size(), fitted.origins.size()); ++i)
    if (fitted.origins[i] == "convention" || fitted.origins[i] == "prior")
      open.push_back(fitted.parameters[i]);
  std::vector<UndeterminedJoint> joints;
  std::string joint = "tool";
  for (std::size_t back = machine.tool.size(); back > 0; --back) {
    const std::size_t axis = axis_of[back - 1];
    if (axis != kNoAxis) joint = machine.axes[axis].name;
    for (const std::string& parameter : open) {
      if (!contains(machine.tool[back - 1], parameter)) continue;
      if (joints.empty() || joints.back().joint != joint) joints.push_back({joint, {}});
      std::vector<std::string>& names = joints.back().parameters;
      if (std::find(names.begin(), names.end(), parameter) == names.end()) names.push_back(parameter);
    }
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

std::string joints_text(const std::vector<UndeterminedJoint>& joints) {
  constexpr std::size_t kMost = 4;  // names in a line
  std::string text;
  for (const UndeterminedJoint& one : joints) {
    text += (text.empty() ? "" : ", ") + one.joint + " (";
    for (std::size_t i = 0; i < std::min(kMost, one.parameters.size()); ++i)
      text += (i > 0 ? ", " : "") + one.parameters[i];
    if (one.parameters.size() > kMost)
      text += " and " + std::to_string(one.parameters.size() - kMost) + " more";
    text += ")";
  }
  return text;
}

}  // namespace vernier::exchange
