// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/simulate.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "hal/sim/analogue_chain.h"
#include "tools/compile/orientation.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/format/columns.h"
#include "tools/kinematics/correction.h"
#include "tools/model/chain/chain.h"
#include "tools/simulate/motion.h"
#include "tools/text/error.h"

namespace vernier::simulate {
namespace {

/// Returns the index in the true machine of every axis of the image's machine.
std::vector<std::size_t> match_axes(const model::Machine& truth, const model::Machine& machine) {
  std::vector<std::size_t> match;
  for (const model::Axis& axis : machine.axes) {
    const auto found = truth.find_axis(axis.name);
    if (!found)
      throw text::InputError({truth.file, 0}, axis.name, "the true machine lacks this axis of the image");
    if (truth.axes[*found].rotary != axis.rotary)
      throw text::InputError({truth.file, truth.axes[*found].line}, axis.name,
                             "rotary in one machine file and linear in the other");
    match.push_back(*found);
  }
  return match;
}

double rms_um(const Eigen::Matrix3Xd& error) {
  return 1e3 * std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
}

double max_um(const Eigen::Matrix3Xd& error) { return 1e3 * error.colwise().norm().maxCoeff(); }

Eigen::Matrix3Xd error_of(const model::Poses& actual, const model::Poses& nominal) {
  return maths::aligned_error(maths::align(actual.position, nominal.position), actual.position,
                              nominal.position);
}

double rms_deg(const model::Column& tilt) { return std::sqrt(tilt.square().mean()); }

double percentile_ns(const Histogram& h, std::uint64_t per_million) {
  return static_cast<double>(h.percentile_ns(per_million));
}

}  // namespace

SimulateResult simulate(const model::Machine& truth, const compile::LoadedImage& image, const Path& path,
                        const LoopOptions& options) {
  const std::vector<std::size_t> match = match_axes(truth, image.machine);
  const Ticks ticks = ticks_of(path, 1e-6 * image.view.header().tick_us);
  SimulateResult result;
  result.states = path_states(path, image.machine, ticks);
  model::States actual = path_states(path, truth, ticks);
  const model::Poses nominal = model::forward(model::nominal_machine(image.machine), result.states),
                     before = model::forward(truth, actual);
  result.error_before = error_of(before, nominal);
  result.tilt_before = kinematics::tilt_between(before, nominal);
  result.loop = run_loop(image.view, image.machine, result.states, options);
  for (std::size_t i = 0; i < match.size(); ++i) actual.axis[match[i]] += result.loop.correction[i];
  const model::Poses after = model::forward(truth, actual);
  result.error_after = error_of(after, nominal);
  result.tilt_after = kinematics::tilt_between(after, nominal);
  if (image.machine.correct_orientation)
    for (const bool damped : compile::damped_poses(image.machine, result.states))
      result.damped += damped ? 1 : 0;
  result.rms_before_um = rms_um(result.error_before);
  result.rms_after_um = rms_um(result.error_after);
  result.max_before_um = max_um(result.error_before);
  result.max_after_um = max_um(result.error_after);
  return result;
}

nlohmann::ordered_json simulate_json(const SimulateResult& result, const model::Machine& machine,
                                     const LoopOptions& options) {
  const LoopResult& loop = result.loop;
  nlohmann::ordered_json json{{"ticks", result.states.count},        {"rms_before_um", result.rms_before_um},
                              {"rms_after_um", result.rms_after_um}, {"max_before_um", result.max_before_um},
                              {"max_after_um", result.max_after_um}, {"saturated", loop.saturated},
                              {"overruns", loop.health.overruns},    {"slewing", loop.slewing},
                              {"beyond_range", loop.beyond_range},   {"not_active", loop.not_active},
                              {"pre_roll_ticks", loop.pre_roll},     {"mode", name_of(loop.mode)},
                              {"fault", name_of(loop.fault)}};
  json["tilt_before_deg"] = rms_deg(result.tilt_before);
  json["tilt_after_deg"] = rms_deg(result.tilt_after);
  json["max_tilt_before_deg"] = result.tilt_before.maxCoeff();
  json["max_tilt_after_deg"] = result.tilt_after.maxCoeff();
  json["damped"] = result.damped;
  json["dac_bits"] = options.dac_bits ? nlohmann::ordered_json(*options.dac_bits) : nullptr;
  json["dac_step_um"] =
      options.dac_bits ? nlohmann::ordered_json(1e-3 * AnalogueChain(*options.dac_bits).step_nm()) : nullptr;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].rotary && loop.correction[i].abs().maxCoeff() > 0)
      json["max_correction_deg"][machine.axes[i].name] = loop.correction[i].abs().maxCoeff();
    if (machine.axes[i].rotary) continue;
    json["max_correction_um"][machine.axes[i].name] = 1e3 * loop.correction[i].abs().maxCoeff();
  }
  json["execution_ns"] = {{"p50", percentile_ns(loop.execution, 500000)},
                          {"p99", percentile_ns(loop.execution, 990000)}};
  return json;
}

std::string ticks_csv(const SimulateResult& result, const model::Machine& machine) {
  std::string text = format::heading(format::columns::kTime);
  for (const model::Axis& axis : machine.axes) text += "," + axis.name + (axis.rotary ? "[deg]" : "[mm]");
  for (const model::Axis& axis : machine.axes)
    text += ",corr_" + axis.name + (axis.rotary ? "[deg]" : "[um]");
  text +=
      ",before_x[um],before_y[um],before_z[um],after_x[um],after_y[um],after_z[um],before_tilt[deg],after_"
      "tilt[deg]\n";
  auto out = std::back_inserter(text);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(result.states.count); ++k) {
    fmt::format_to(out, "{:.6f}", result.states.time[k]);
    for (const model::Column& axis : result.states.axis) fmt::format_to(out, ",{:.6f}", axis[k]);
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      fmt::format_to(out, ",{:.6f}", result.loop.correction[i][k] * (machine.axes[i].rotary ? 1 : 1e3));
    for (const Eigen::Matrix3Xd* error : {&result.error_before, &result.error_after})
      for (Eigen::Index row = 0; row < 3; ++row) fmt::format_to(out, ",{:.5f}", 1e3 * (*error)(row, k));
    fmt::format_to(out, ",{:.7f},{:.7f}", result.tilt_before[k], result.tilt_after[k]);
    text += '\n';
  }
  return text;
}

}  // namespace vernier::simulate
