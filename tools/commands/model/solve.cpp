// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/kinematics/at.h"
#include "tools/kinematics/closed.h"
#include "tools/kinematics/rotations.h"
#include "tools/results/result_json.h"
#include "tools/text/assurance.h"

namespace vernier::commands::solve_cli {
namespace {

constexpr double kRangeSlack = 1e-9;  // mm or deg: a target on the limit itself

struct SolveArguments {
  std::string machine, target, start, match = "auto", json;
  std::vector<std::string> axes;
  bool nominal = false;
  int restarts = 48;
};

kinematics::InverseOptions options_of(const SolveArguments& arguments, const model::Machine& machine,
                                      bool with_rotation) {
  kinematics::InverseOptions options;
  const std::map<std::string, kinematics::Match> names = {{"position", kinematics::Match::kPosition},
                                                          {"direction", kinematics::Match::kDirection},
                                                          {"pose", kinematics::Match::kPose}};
  if (arguments.match == "auto")
    options.match = with_rotation ? kinematics::Match::kPose : kinematics::Match::kPosition;
  else
    options.match = names.at(arguments.match);
  if (options.match != kinematics::Match::kPosition && !with_rotation)
    throw text::InputError({}, arguments.target,
                           "a target with direction or pose needs a rotation too: x,y,z,rx,ry,rz");
  for (const std::string& name : arguments.axes) {
    const auto axis = machine.find_axis(name);
    if (!axis) throw text::InputError({machine.file, 0}, name, "the machine has no axis of this name");
    options.axes.push_back(*axis);
  }
  return options;
}

/// The axes found bring the tool to the target, and may be there.
text::Assurance assurance_of(const model::Machine& machine, const kinematics::InverseResult& result,
                             const kinematics::InverseOptions& options) {
  const kinematics::Inverse& proof = result.each[0];
  text::Assurance assurance(text::AssuranceKind::kSolve);
  assurance.at_most("residual-mm", proof.residual_mm, options.tolerance_mm,
                    "Distance of the tool point from the target, mm.");
  if (options.match != kinematics::Match::kPosition)
    assurance.at_most("residual-deg", proof.residual_deg, options.tolerance_deg,
                      "Angle between the tool and the target, deg.");
  assurance.require("solved", proof.converged,
                    "The solution is not a singular pose and is within all axis ranges.");
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const model::Axis& axis = machine.axes[i];
    const double value = result.states.axis[i][0];
    if (axis.min)
      assurance.at_least("min-" + axis.name, value, *axis.min - kRangeSlack, "Lower end of its range.");
    if (axis.max)
      assurance.at_most("max-" + axis.name, value, *axis.max + kRangeSlack, "Upper end of its range.");
    if (!axis.min || !axis.max)
      assurance.not_covered(fmt::format(
          "The range of an axis is not known, because the machine file has no min and max: {}.", axis.name));
  }
  assurance.not_covered("Collisions are not tested.");
  return assurance;
}

/// Result of a Newton iteration, and whether the closed form agrees.
nlohmann::ordered_json solution_json(const model::Machine& machine, const kinematics::InverseResult& result,
                                     const model::States& start, const model::Poses& target,
                                     const kinematics::InverseOptions& options) {
  nlohmann::ordered_json json = {{"machine", machine.name},
                                 {"axes", results::axes_json(machine, result.states)},
                                 {"reached", results::pose_json(model::forward(machine, result.states))},
                                 {"proof", results::inverse_json(machine, result.each[0])},
                                 {"closed_form", nullptr},
                                 {"assurance", assurance_of(machine, result, options).json()}};
  const bool position_only = options.match == kinematics::Match::kPosition;
  const auto closed = position_only ? kinematics::closed_solution(machine, start) : std::nullopt;
  if (!closed) return json;
  const Eigen::MatrixXd q = kinematics::solve_closed(*closed, target.position);
  for (std::size_t k = 0; k < closed->axes.size(); ++k)
    json["closed_form"][machine.axes[closed->axes[k]].name] = q(static_cast<Eigen::Index>(k), 0);
  return json;
}

std::string failure_text(const model::Machine& machine, const kinematics::Inverse& proof) {
  const std::string residual =
      fmt::format("residual {:.3g} mm, {:.3g} deg after {} iterations, condition {:.3g}", proof.residual_mm,
                  proof.residual_deg, proof.iterations, proof.condition);
  if (proof.fault == kinematics::InverseFault::kSingular)
    return fmt::format(
        "no solution: the pose is singular, so the axes cannot move the tool in every direction ({})",
        residual);
  if (proof.fault == kinematics::InverseFault::kBeyondRange)
    return fmt::format("no solution: an axis would have to leave its range: {} ({})",
                       machine.axes[proof.axis].name, residual);
  return fmt::format("no solution: the target is out of reach of these axes ({})", residual);
}

void run_solve(const SolveArguments& arguments) {
  const model::Machine read = read_model(arguments.machine);
  const model::Machine machine = arguments.nominal ? model::nominal_machine(read) : read;
  const std::vector<double> numbers =
      kinematics::number_list(arguments.target, {3, 6}, "a target x,y,z or x,y,z,rx,ry,rz");
  model::Poses target;
  target.position = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  target.rotation = {Eigen::Matrix3d::Identity()};
  if (numbers.size() == 6) target.rotation = {kinematics::rotation_of({numbers[3], numbers[4], numbers[5]})};
  const kinematics::InverseOptions options = options_of(arguments, machine, numbers.size() == 6);
  const model::States start = kinematics::state_at(machine, arguments.start);
  const kinematics::InverseResult result =
      kinematics::solve_anywhere(machine, target, start, options, arguments.restarts);
  const kinematics::Inverse& proof = result.each[0];
  write_json(arguments.json, solution_json(machine, result, start, target, options));
  if (!proof.converged) throw text::LimitNotMet(failure_text(machine, proof));
  std::FILE* out = human_stream(arguments.json);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    fmt::print(out, "{:<10} {:.9f} {}\n", machine.axes[i].name, result.states.axis[i][0],
               machine.axes[i].rotary ? "deg" : "mm");
  fmt::print(out, "residual   {:.3g} mm, {:.3g} deg after {} iterations; condition {:.3g}\n",
             proof.residual_mm, proof.residual_deg, proof.iterations, proof.condition);
}

}  // namespace

void register_solve(CLI::App& vernier) {
  auto arguments = std::make_shared<SolveArguments>();
  CLI::App* command =
      vernier.add_subcommand("solve", "Compute the axis positions of a tool pose (inverse solution)");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command
      ->add_option("--target", arguments->target,
                   "target in workpiece coordinates: tool point x,y,z (mm); for a pose also the rotation "
                   "vector rx,ry,rz (deg) of the tool")
      ->required();
  command->add_option("--start", arguments->start,
                      "start positions of the axes, motion and inputs: \"X=100,B=20,T=25\"");
  command->add_option("--axes", arguments->axes, "axes that the solution may move; default: all axes")
      ->delimiter(',');
  command
      ->add_option("--match", arguments->match,
                   "kind of target; auto: position if no rotation is given, pose otherwise")
      ->check(CLI::IsMember({"auto", "position", "direction", "pose"}))
      ->capture_default_str();
  command->add_flag("--nominal", arguments->nominal,
                    "solve for the nominal machine; default: solve for the machine with its errors");
  command
      ->add_option("--restarts", arguments->restarts,
                   "number of additional start positions, distributed over the axis ranges")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "The command verifies every solution: it compares the forward kinematics of the computed axis "
      "positions with the target. Exit status\n"
      "0 done, 1 bad input, 2 no solution: the pose is singular, out of reach, or beyond an axis range.");
  command->callback([arguments] { run_solve(*arguments); });
}

}  // namespace vernier::commands::solve_cli
