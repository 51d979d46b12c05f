// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/kinematics/at.h"
#include "tools/kinematics/correction.h"
#include "tools/results/fit_findings.h"
#include "tools/results/result_json.h"

namespace vernier::commands::pose_cli {
namespace {

/// Part of the standard uncertainty above which the text states that it is not measured: half of the
/// variance.
constexpr double kMostlyOpen = 0.7;

struct PoseArguments {
  std::string machine, at, tool, json;
  bool with_rotary = false;
};

void run_pose(const PoseArguments& arguments) {
  const model::Machine machine = kinematics::tooled(read_model(arguments.machine), arguments.tool);
  const model::States states = kinematics::state_at(machine, arguments.at);
  const model::Poses actual = model::forward(machine, states),
                     nominal = model::forward(model::nominal_machine(machine), states);
  nlohmann::ordered_json json = {{"machine", machine.name},
                                 {"axes", results::axes_json(machine, states)},
                                 {"actual", results::pose_json(actual)},
                                 {"nominal", results::pose_json(nominal)}};
  std::FILE* out = human_stream(arguments.json);
  const Eigen::Vector3d deviation = actual.position.col(0) - nominal.position.col(0);
  json["deviation_um"] = {1000 * deviation.x(), 1000 * deviation.y(), 1000 * deviation.z()};
  bool mostly_open = false;
  const fit::Reach reach(machine);
  if (reach.known()) {
    const Eigen::Vector3d std_um = 1000 * reach.covariance_of_machine(states)[0].diagonal().cwiseSqrt();
    json["std_um"] = {std_um.x(), std_um.y(), std_um.z()};
    const Eigen::Vector3d open_um = reach.std_unmeasured_um(states).col(0);
    json["std_not_measured_um"] = {open_um.x(), open_um.y(), open_um.z()};
    mostly_open = open_um.norm() > kMostlyOpen * std_um.norm();
  }
  json["findings"] = results::findings_json(machine);
  const double tilt_deg = kinematics::tilt_between(actual, nominal)[0];
  json["tilt_deg"] = tilt_deg;
  json["correction"] = nullptr;
  results::print_pose(out, "nominal", nominal);
  results::print_pose(out, "actual", actual);
  const Eigen::Vector3d shown_um = results::without_minus_zero(1000 * deviation, 4);
  fmt::print(out, "deviation  {:10.4f} {:10.4f} {:10.4f} um\n", shown_um.x(), shown_um.y(), shown_um.z());
  if (reach.known())
    fmt::print(
        out, "known to   {:10.4f} {:10.4f} {:10.4f} um (standard uncertainty, with the model discrepancy)\n",
        json["std_um"][0].get<double>(), json["std_um"][1].get<double>(), json["std_um"][2].get<double>());
  if (mostly_open)
    fmt::print(out,
               "not measured: {:.4f} {:.4f} {:.4f} um of this uncertainty come from parameters that no "
               "reading determined; these parameters stay at nominal +- scale\n",
               json["std_not_measured_um"][0].get<double>(), json["std_not_measured_um"][1].get<double>(),
               json["std_not_measured_um"][2].get<double>());
  fmt::print(out, "tilt       {:10.6f} deg\n", tilt_deg);
  const bool with_rotary = arguments.with_rotary || machine.correct_orientation;
  if (!with_rotary && kinematics::linear_axes(machine).empty()) {
    fmt::print(out, "the machine has no linear axis that can correct; --rotary corrects with all axes\n");
    write_json(arguments.json, json);
    return;
  }
  const kinematics::CorrectionResult corrected =
      kinematics::correct(machine, states, {.with_rotary = with_rotary});
  json["correction"] = results::correction_json(machine, corrected);
  write_json(arguments.json, json);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    fmt::print(out, "correction {:<8} {:+.7f} {}\n", machine.axes[i].name, corrected.offset[i][0],
               machine.axes[i].rotary ? "deg" : "mm");
  fmt::print(out, "left       {:.3g} mm, {:.3g} deg tilt, after {} iterations\n",
             corrected.after.col(0).norm(), corrected.tilt_after[0], corrected.each[0].iterations);
  if (!corrected.each[0].converged) throw text::LimitNotMet("the correction does not converge at this pose");
}

}  // namespace

void register_pose(CLI::App& vernier) {
  auto arguments = std::make_shared<PoseArguments>();
  CLI::App* command = vernier.add_subcommand(
      "pose", "Compute tool position, deviation and correction at axis positions (forward solution)");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("--at", arguments->at,
                      "axis positions, motion and inputs: \"X=100,Y=-20,dirX=1,T=25\"");
  command->add_option("--tool", arguments->tool,
                      "a tool of the file's <tools>, or \"X,Y,Z\" in mm from the end of the chain");
  command->add_flag("--rotary", arguments->with_rotary,
                    "correct with all axes, tool point and tool direction; default: linear axes, tool point");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Tool point in workpiece coordinates (no BaseShift), mm; rotation vector in deg. Exit status 0 done,\n"
      "1 bad input, 2 the correction does not converge.");
  command->callback([arguments] { run_pose(*arguments); });
}

}  // namespace vernier::commands::pose_cli
