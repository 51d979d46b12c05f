// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/b_head_machine.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/format/units.h"
#include "tools/model/chain/chain.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::part {
namespace {

/// Far above rounding of a chain of this size (1e-12 mm), far below any error that matters.
constexpr double kSameMm = 1e-8, kSameAxis = 1e-11;

/// Poses that distinguish the nominal chain from any other chain of linear and rotary axes: each axis alone,
/// in both directions, and all axes together.
const std::vector<JointPose> kProbes = {{0, 0, 0, 0, 0},       {70, 0, 0, 0, 0},      {0, -60, 0, 0, 0},
                                        {0, 0, 90, 0, 0},      {0, 0, 0, 25, 0},      {0, 0, 0, -35, 0},
                                        {0, 0, 0, 0, 50},      {0, 0, 0, 0, -110},    {40, 30, 20, 10, 60},
                                        {-50, 80, 5, -17, 95}, {33, -44, 55, 18, -20}};

/// Value of one "NAME=NUMBER[UNIT]" in the unit of the static.
double error_value(const model::Static& target, const std::string& word, const std::string& text) {
  std::size_t split = text.size();
  while (split > 0 && !text::parse_number(text.substr(0, split))) --split;
  const std::optional<double> number = text::parse_number(text.substr(0, split));
  if (!number) throw text::InputError({"--errors", 0}, word, "not a number");
  const std::string name = text.substr(split);
  if (name.empty()) return *number;
  const std::optional<format::Unit> from = format::find_unit(name), to = format::find_unit(target.unit);
  if (!from || !to || from->dimension != to->dimension)
    throw text::InputError(
        {"--errors", 0}, word,
        fmt::format("\"{}\" cannot be converted to \"{}\", the unit of {}", name, target.unit, target.name));
  return (*number * from->factor + from->offset - to->offset) / to->factor;
}

}  // namespace

model::States BHeadMachine::states(const std::vector<JointPose>& joints) const {
  model::States result = model::make_states(joints.size(), machine);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const JointPose& q = joints[i];
    const std::array<double, 5> value = {q.x_mm, q.y_mm, q.z_mm, q.b_deg, q.c_deg};
    for (std::size_t k = 0; k < 5; ++k) result.axis[axis[k]][row] = value[k];
  }
  return result;
}

BHeadMachine b_head_machine(model::Machine machine) {
  BHeadMachine result;
  result.machine = std::move(machine);
  const text::Place place{result.machine.file, 0};
  constexpr std::array<const char*, 5> kAxes = {"X", "Y", "Z", "B", "C"};
  for (std::size_t k = 0; k < 5; ++k) {
    const auto found = result.machine.find_axis(kAxes[k]);
    if (!found) throw text::InputError(place, kAxes[k], "the S-shaped part needs a machine with this axis");
    result.axis[k] = *found;
  }
  const model::Poses poses = model::forward(model::nominal_machine(result.machine), result.states(kProbes));
  result.pivot_mm = -poses.position(2, 0);
  for (std::size_t i = 0; i < kProbes.size(); ++i) {
    const ToolPose want = tool_pose(kProbes[i], result.pivot_mm);
    const double apart = (poses.position.col(static_cast<Eigen::Index>(i)) - want.tip).norm();
    const double turned = (poses.rotation[i].col(2) - want.axis).norm();
    if (apart > kSameMm || turned > kSameAxis)
      throw text::InputError(
          place, result.machine.name,
          fmt::format("the nominal chain is not X Z B on the tool side and Y C on the workpiece side with "
                      "crossing axes: at X {} Y {} Z {} B {} C {} the tool pose differs from that of such a "
                      "chain by {:.3g} mm and {:.3g} rad",
                      kProbes[i].x_mm, kProbes[i].y_mm, kProbes[i].z_mm, kProbes[i].b_deg, kProbes[i].c_deg,
                      apart, turned));
  }
  return result;
}

void set_errors(model::Machine& machine, const std::string& text) {
  for (const std::string& word : text::words_in(text, ", ")) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw text::InputError({"--errors", 0}, word, "expected NAME=VALUE");
    const auto index = machine.find_static(word.substr(0, equals));
    if (!index)
      throw text::InputError({"--errors", 0}, word,
                             fmt::format("no constant (static) has this name in {}", machine.name));
    model::Static& target = machine.statics[*index];
    if (target.hidden)
      throw text::InputError({"--errors", 0}, word,
                             "this constant has Hide=\"true\" in the machine file, so it cannot be an error: "
                             "name a constant that a fit may change");
    if (!target.nominal) target.nominal = target.value;
    target.value = error_value(target, word, word.substr(equals + 1));
  }
}

}  // namespace vernier::part
