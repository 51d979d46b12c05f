// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/field_json.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/fit/coverage/reach.h"
#include "tools/kinematics/at.h"

namespace vernier::results {

namespace {

using Json = nlohmann::ordered_json;

Json vectors(const Eigen::Matrix3Xd& columns, double factor) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    list.push_back({factor * columns(0, i), factor * columns(1, i), factor * columns(2, i)});
  return list;
}

}  // namespace

Json field_json(const model::Machine& machine, const map::ErrorField& field) {
  Json axes = Json::array();
  for (const std::size_t axis : field.axes) axes.push_back(machine.axes[axis].name);
  const Eigen::VectorXd size_um = 1000 * field.deviation.colwise().norm();
  Eigen::Index worst = 0;
  const double max_um = size_um.maxCoeff(&worst);
  const Eigen::Vector3d at = field.nominal.col(worst);
  Json json = {{"axes", axes},
               {"counts", field.counts},
               {"max_um", max_um},
               {"rms_um", std::sqrt(size_um.squaredNorm() / static_cast<double>(size_um.size()))},
               {"max_at_mm", {at.x(), at.y(), at.z()}},
               {"point_mm", vectors(field.nominal, 1)},
               {"deviation_um", vectors(field.deviation, 1000)}};
  json["std_um"] = nullptr;
  if (const fit::Reach reach(machine); reach.known()) {
    const Eigen::VectorXd std_um = reach.std_of_machine_um(field.states);
    json["std_um"] = std::vector<double>(std_um.begin(), std_um.end());
    json["max_std_um"] = std_um.maxCoeff();
    const auto nodes = static_cast<double>(std_um.size());
    json["rms_std_um"] = std::sqrt(std_um.squaredNorm() / nodes);
    json["rms_std_not_measured_um"] = std::sqrt(reach.std_unmeasured_um(field.states).squaredNorm() / nodes);
  }
  return json;
}

model::States middle_state(const model::Machine& machine, const std::string& words) {
  std::string all;
  for (const model::Axis& axis : machine.axes)
    if (axis.min && axis.max && !axis.rotary)
      all += fmt::format("{}={},", axis.name, (*axis.min + *axis.max) / 2);
  all += words;
  if (!all.empty() && all.back() == ',') all.pop_back();
  return kinematics::state_at(machine, all);
}

std::optional<Json> volume_json(const model::Machine& machine, std::size_t count, std::string& why_not) {
  try {
    const std::vector<std::size_t> axes = kinematics::linear_axes(machine);
    return field_json(machine, map::error_field(machine, middle_state(machine, ""), axes, count));
  } catch (const text::InputError& error) {
    why_not = error.what();
    return std::nullopt;
  }
}

}  // namespace vernier::results
