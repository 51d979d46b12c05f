// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/probe/circle_path.h"

namespace vernier::commands::ballbar_path_cli {
namespace {

const std::map<std::string, probe::CircleDialect> kDialects = {{"iso", probe::CircleDialect::kIso},
                                                               {"linuxcnc", probe::CircleDialect::kLinuxcnc},
                                                               {"urscript", probe::CircleDialect::kUrscript}};

struct Arguments {
  probe::CirclePath path;
  std::vector<double> arc = {0, 360}, centre = {0, 0, 0}, tool = {0, 0, 0};
  std::string dialect = "iso", output;
};

void run(Arguments& arguments) {
  probe::CirclePath& path = arguments.path;
  path.from_deg = arguments.arc[0], path.to_deg = arguments.arc[1];
  for (std::size_t k = 0; k < 3; ++k)
    path.centre_mm[k] = arguments.centre[k], path.tool_deg[k] = arguments.tool[k];
  text::write_file(arguments.output, probe::circle_program(path, kDialects.at(arguments.dialect)));
  fmt::print("{}: {} plane, radius {:g} mm, {:g} mm/min, {:g} to {:g} deg and {:g} deg more on either side\n",
             arguments.output, path.plane, path.radius_mm, path.feed_mm_min, path.from_deg, path.to_deg,
             path.overshoot_deg);
}

}  // namespace

void register_ballbar_path(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  probe::CirclePath& path = arguments->path;
  CLI::App* command =
      vernier.add_subcommand("ballbar-path", "Write the program of a circular test for a machine or a robot");
  command
      ->add_option("--plane", path.plane,
                   "plane of the circle; angles count from the first axis to the second axis")
      ->capture_default_str()
      ->check(CLI::IsMember({"XY", "YZ", "ZX"}));
  command->add_option("--radius", path.radius_mm, "length of the ball bar, mm")->capture_default_str();
  command->add_option("--feed", path.feed_mm_min, "feed along the circle, mm/min")->required();
  command->add_option("--arc", arguments->arc, "FROM,TO of the arc that is analysed, deg; default 0,360")
      ->delimiter(',')
      ->expected(2);
  command
      ->add_option("--overshoot", path.overshoot_deg,
                   "angle of the circle before and after the evaluated arc, deg")
      ->capture_default_str();
  command
      ->add_option("--feed-in", path.feed_in_mm,
                   "radial distance from the circle at which the approach begins and the exit ends, mm")
      ->capture_default_str();
  command->add_option("--pause", path.pause_s, "pause between the two directions of motion, s")
      ->capture_default_str();
  command->add_option("--centre", arguments->centre, "X,Y,Z mm; default 0,0,0")->delimiter(',')->expected(3);
  command->add_option("--dialect", arguments->dialect, "iso, linuxcnc, urscript")
      ->capture_default_str()
      ->check(CLI::IsMember({"iso", "linuxcnc", "urscript"}));
  command->add_option("--tool", arguments->tool, "urscript: rotation vector of the tool, deg; default 0,0,0")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--acceleration", path.acceleration_mm_s2, "urscript: mm/s^2")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "the program")->type_name(kWrites)->required();
  command->footer(
      "The program moves along the circle in both directions, each with its approach and its exit, and stops "
      "at the start\n"
      "point so that the ball bar can be mounted. Check the path for collisions before you run it: the "
      "command knows no obstacles.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::commands::ballbar_path_cli
