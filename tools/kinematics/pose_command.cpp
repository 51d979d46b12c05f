#include <fmt/format.h>

#include <memory>

#include "tools/cli/command.h"
#include "tools/kinematics/at.h"
#include "tools/kinematics/correction.h"
#include "tools/kinematics/result_json.h"

namespace vernier {
namespace {

struct PoseArguments {
  std::string machine, at, json;
  bool with_rotary = false;
};

void run_pose(const PoseArguments& arguments) {
  const Machine machine = read_machine(arguments.machine);
  const States states = state_at(machine, arguments.at);
  const Poses actual = forward(machine, states), nominal = forward(nominal_machine(machine), states);
  nlohmann::ordered_json json = {{"machine", machine.name},
                                 {"axes", axes_json(machine, states)},
                                 {"actual", pose_json(actual)},
                                 {"nominal", pose_json(nominal)}};
  std::FILE* out = human_stream(arguments.json);
  const Eigen::Vector3d deviation = actual.position.col(0) - nominal.position.col(0);
  json["deviation_um"] = {1000 * deviation.x(), 1000 * deviation.y(), 1000 * deviation.z()};
  json["correction"] = nullptr;
  print_pose(out, "nominal", nominal);
  print_pose(out, "actual", actual);
  fmt::print(out, "deviation  {:10.4f} {:10.4f} {:10.4f} um\n", 1000 * deviation.x(), 1000 * deviation.y(),
             1000 * deviation.z());
  if (!arguments.with_rotary && linear_axes(machine).empty()) {
    fmt::print(out, "no linear axis to correct with; --rotary corrects with all axes\n");
    write_json(arguments.json, json);
    return;
  }
  const CorrectionResult corrected = correct(machine, states, {.with_rotary = arguments.with_rotary});
  json["correction"] = correction_json(machine, corrected);
  write_json(arguments.json, json);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    fmt::print(out, "correction {:<8} {:+.7f} {}\n", machine.axes[i].name, corrected.offset[i][0],
               machine.axes[i].rotary ? "deg" : "mm");
  fmt::print(out, "left       {:.3g} mm, {:.3g} deg tilt, after {} iterations\n",
             corrected.after.col(0).norm(), corrected.tilt_after[0], corrected.each[0].iterations);
  if (!corrected.each[0].converged) throw LimitNotMet("the correction does not converge at this pose");
}

}  // namespace

void register_pose(CLI::App& vernier) {
  auto arguments = std::make_shared<PoseArguments>();
  CLI::App* command = vernier.add_subcommand(
      "pose",
      "Where the tool is at given axis positions, how far off, and the correction (forward solution)");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->required();
  command->add_option("--at", arguments->at,
                      "axis positions, motion and inputs: \"X=100,Y=-20,dirX=1,T=25\"");
  command->add_flag("--rotary", arguments->with_rotary,
                    "correct with all axes, tool point and tool direction; default: linear axes, tool point");
  command->add_option("--json", arguments->json, "result for programs; - for standard output");
  command->footer(
      "Tool point in workpiece coordinates (no BaseShift), mm; rotation vector in deg. Exit status 0 done,\n"
      "1 bad input, 2 the correction does not converge.");
  command->callback([arguments] { run_pose(*arguments); });
}

}  // namespace vernier
