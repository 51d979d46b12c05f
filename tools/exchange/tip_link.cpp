// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/tip_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <pugixml.hpp>

#include "tools/maths/factors.h"
#include "tools/model/expression.h"
#include "tools/text/words.h"

namespace vernier::exchange {
namespace {

/// The tool point in the frame of the last row, as `vernier new` writes it; 0 for a static that is not there.
Eigen::Vector3d tool_point(const model::Machine& machine) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const model::Static& one : machine.statics)
    for (Eigen::Index k = 0; k < 3; ++k)
      if (one.name == std::string("TP") + "XYZ"[k]) point[k] = one.value;
  return point;
}

std::string label_of(const model::BaseShift& shift) {
  return shift.run ? fmt::format("ToolShift[{}]", *shift.run) : "ToolShift";
}

/// Place of a ToolShift in the frame in which `vernier new --tool` takes the tool point, mm: that of a link.
Eigen::Vector3d place_in_link(const model::Machine& machine, const model::BaseShift& shift,
                              const TipLink& link) {
  return link.frame.inverse() *
         (tool_point(machine) + Eigen::Vector3d(shift.value[0], shift.value[1], shift.value[2]));
}

}  // namespace

std::optional<TipLink> tip_link(const std::string& text) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size());
  for (const pugi::xml_node& list : document.document_element().children()) {
    if (!list.attribute("link")) continue;
    std::array<double, 6> at{};
    const std::vector<std::string> words = text::words_in(list.attribute("frame").as_string(), " ");
    for (std::size_t k = 0; k < std::min(words.size(), at.size()); ++k) at[k] = std::stod(words[k]);
    TipLink link{list.attribute("link").as_string(), Eigen::Isometry3d::Identity()};
    link.frame.translate(Eigen::Vector3d(at[0], at[1], at[2]));
    for (Eigen::Index k = 0; k < 3; ++k)
      link.frame.rotate(Eigen::AngleAxisd(at[static_cast<std::size_t>(3 + k)] * maths::kRadPerDeg,
                                          Eigen::Vector3d::Unit(k)));
    return link;
  }
  return std::nullopt;
}

std::optional<model::Machine> with_tool_point_at_reflector(const model::Machine& machine) {
  if (machine.tool_shifts.size() != 1 || machine.tool_shifts.front().run) return std::nullopt;
  model::Machine moved = machine;
  model::Transform row;
  row.line = 0;  // not in the file
  row.n = moved.tool.empty() ? 1 : moved.tool.back().n + 1;
  for (std::size_t dof = 0; dof < row.dof_count(); ++dof) {
    double& shift = moved.tool_shifts.front().value[dof];
    const double at = dof < 3 ? shift : 0;
    if (dof < 3) shift = 0;
    row.text[dof] = fmt::format("{}", at);
    row.dof[dof] = model::make_number(at);
  }
  moved.tool.push_back(row);
  return moved;
}

TipLink tool_link(const model::Machine& machine, const std::string& name) {
  TipLink link{name, Eigen::Isometry3d::Identity()};
  link.frame.translate(tool_point(machine));
  return link;
}

std::vector<std::string> tool_shift_places(const model::Machine& machine, const TipLink& link,
                                           const std::string& urdf) {
  std::vector<std::string> sentences;
  for (const model::BaseShift& shift : machine.tool_shifts) {
    const Eigen::Vector3d at = place_in_link(machine, shift, link);
    sentences.push_back(
        fmt::format("{} is at {:.4f}, {:.4f}, {:.4f} mm in the frame of the link {} of {}; its "
                    "parameters are in the frame of the last row of the machine file",
                    label_of(shift), at.x(), at.y(), at.z(), link.name, urdf));
  }
  return sentences;
}

std::vector<std::string> tool_shift_places(const model::Machine& machine, const std::string& text) {
  if (machine.tool_shifts.empty()) return {};
  if (const std::optional<TipLink> link = tip_link(text))
    return tool_shift_places(machine, *link, "the URDF");
  return {
      "ToolShift is in the frame of the tool: its origin is the tool point, its axes are those of the last "
      "row of <transforms>"};
}

}  // namespace vernier::exchange
