// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/linuxcnc_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "tools/model/machine_reader.h"
#include "tools/text/words.h"

namespace vernier::exchange {
namespace {

// Limits of the component (comp/equation.h), and of a pin's name (HAL_NAME_LEN less "vernier.0.input.").
constexpr std::size_t kMostJoints = 8, kMostInputs = 24, kLongestName = 23;

std::vector<const model::Input*> sensors(const model::Machine& machine) {
  std::vector<const model::Input*> result;
  for (const model::Input& input : machine.inputs) result.push_back(&input);
  return result;
}

void check_names(const model::Machine& machine) {
  const auto check = [&](const std::string& name, std::size_t line) {
    const bool good =
        name.size() <= kLongestName && std::all_of(name.begin(), name.end(), [](unsigned char c) {
          return std::isalnum(c) != 0 || c == '_' || c == '-';
        });
    if (!good)
      throw text::InputError({machine.file, line}, name, "this name cannot be the name of a HAL pin");
  };
  if (machine.axes.size() > kMostJoints)
    throw text::InputError({machine.file, 0}, machine.axes[kMostJoints].name,
                           "the machine has more axes than the component has joints");
  if (machine.inputs.size() > kMostInputs)
    throw text::InputError({machine.file, 0}, machine.inputs[kMostInputs].name,
                           "the machine has more inputs than the component supports");
  for (const model::Axis& axis : machine.axes) check(axis.name, axis.line);
  for (const model::Input* input : sensors(machine)) check(input->name, input->line);
}

// Only where the component would take another kind from the name.
std::string rotary_argument(const model::Machine& machine) {
  std::string names;
  bool by_name = true;
  for (const model::Axis& axis : machine.axes) {
    const bool usual = axis.name == "A" || axis.name == "B" || axis.name == "C";
    by_name = by_name && axis.rotary == usual;
    if (axis.rotary) names += (names.empty() ? "" : ",") + axis.name;
  }
  return by_name ? "" : " rotary=" + (names.empty() ? std::string("none") : names);
}

std::string load_line(const model::Machine& machine) {
  std::string axes, inputs;
  for (const model::Axis& axis : machine.axes) axes += (axes.empty() ? "" : ",") + axis.name;
  for (const model::Input* input : sensors(machine)) inputs += (inputs.empty() ? "" : ",") + input->name;
  return "loadrt vernier axes=" + axes + (inputs.empty() ? "" : " inputs=" + inputs) +
         rotary_argument(machine) + " units=[TRAJ]LINEAR_UNITS";
}

std::string joint_lines(std::size_t n) {
  return fmt::format(
      "unlinkp joint.{0}.motor-pos-cmd\n"
      "unlinkp joint.{0}.motor-pos-fb\n"
      "net vernier-cmd-{0} joint.{0}.motor-pos-cmd => vernier.0.joint.{0}.cmd-in\n"
      "net [VERNIER]CMD_{0} vernier.0.joint.{0}.cmd-out\n"
      "net [VERNIER]FB_{0} vernier.0.joint.{0}.fb-in\n"
      "net vernier-fb-{0} vernier.0.joint.{0}.fb-out => joint.{0}.motor-pos-fb\n"
      "net vernier-pos-{0} joint.{0}.pos-cmd => vernier.0.joint.{0}.pos-in\n"
      "net vernier-homed-{0} joint.{0}.homed => vernier.0.joint.{0}.homed\n"
      "setp vernier.0.joint.{0}.min-limit [JOINT_{0}]MIN_LIMIT\n"
      "setp vernier.0.joint.{0}.max-limit [JOINT_{0}]MAX_LIMIT\n"
      "setp vernier.0.joint.{0}.max-velocity [JOINT_{0}]MAX_VELOCITY\n",
      n);
}

std::string hal_file(const model::Machine& machine) {
  std::string text = fmt::format(
      "# {}: the correction between the joints and their drives. Loaded after the files that connect the "
      "drives.\n"
      "# If the INI file has no MIN_LIMIT, MAX_LIMIT or MAX_VELOCITY for a joint, delete the setp line of "
      "this value.\n"
      "# Positions, limits and corrections in this file are in [TRAJ]LINEAR_UNITS, mm or inch; those of the "
      "machine file are in mm.\n"
      "{}\n"
      "addf vernier.0 servo-thread [VERNIER]POSITION\n",
      machine.name, load_line(machine));
  for (std::size_t n = 0; n < machine.axes.size(); ++n)
    text += fmt::format("\n# joint {}: {}\n", n, machine.axes[n].name) + joint_lines(n);
  text += "\nnet vernier-vel motion.current-vel => vernier.0.current-vel\n";
  if (!machine.inputs.empty())
    text +=
        "\n"
        "# Sensors: until each sensor is connected, the component gives no correction. Write the names of "
        "your pins here.\n";
  for (const model::Input* input : sensors(machine))
    text += fmt::format("# net {} YOUR-SENSOR.PIN => vernier.0.input.{}   # {}, reference {:g}\n",
                        text::in_small_letters(input->name), input->name,
                        input->unit.empty() ? "no unit" : input->unit, input->reference);
  return text +
         "\n"
         "# 0: the correction stops at the limit of a joint; 1: the component also ends the NC program: net "
         "vernier-abort vernier.0.abort halui.abort\n"
         "setp vernier.0.limit-mode 0\n"
         "loadusr -W vernier-hal --store [VERNIER]STORE --public-key [VERNIER]PUBLIC_KEY --listen "
         "[VERNIER]LISTEN --image [VERNIER]IMAGE\n"
         "setp vernier.0.enable 1\n";
}

// Motions that the controller refuses need no hold.
std::string narrower_limits(const model::Machine& machine) {
  std::string text;
  for (std::size_t n = 0; n < machine.axes.size(); ++n) {
    const model::Axis& axis = machine.axes[n];
    if (axis.min && axis.max && axis.max_correction)
      text += fmt::format("#   [JOINT_{}] MIN_LIMIT = {:.6g}, MAX_LIMIT = {:.6g}\n", n,
                          *axis.min + *axis.max_correction, *axis.max - *axis.max_correction);
  }
  return text.empty() ? text
                      : "# If the correction would move a joint beyond its limit, the joint stops at the "
                        "limit (vernier.hal). If the soft limits\n"
                        "# are narrower by the largest correction, LinuxCNC refuses such a program before it "
                        "starts. Narrower limits for the ranges\n"
                        "# of the machine file, mm and deg:\n" +
                            text;
}

std::string ini_lines(const model::Machine& machine, const std::string& folder) {
  std::string text = fmt::format(
      "# Into your INI file: this line as the last HALFILE of its section [HAL],\n"
      "#   HALFILE = {0}/vernier.hal\n"
      "# and the section below.\n"
      "[VERNIER]\n"
      "# Where the component runs in the servo thread: right after motion-controller, which `halcmd show "
      "thread` numbers\n"
      "# from 1; 3 if only motion-command-handler is before that.\n"
      "POSITION = 3\n"
      "STORE = {0}/store\n"
      "PUBLIC_KEY = {0}/vernier.pub\n"
      "IMAGE = {0}/image\n"
      "LISTEN = 127.0.0.1:1502\n"
      "# Signals that take a joint's command to its drive and its feedback back, as your HAL files call "
      "them.\n",
      folder);
  for (std::size_t n = 0; n < machine.axes.size(); ++n)
    text += fmt::format("CMD_{0} = {1}-pos-cmd\nFB_{0} = {1}-pos-fb\n", n,
                        text::in_small_letters(machine.axes[n].name));
  return text + narrower_limits(machine);
}

std::string readme(const model::Machine& machine, const std::string& folder) {
  std::string joints;
  for (std::size_t n = 0; n < machine.axes.size(); ++n)
    joints += fmt::format("{}joint {} = {}", n == 0 ? "" : ", ", n, machine.axes[n].name);
  return fmt::format(
      "# {0} in LinuxCNC\n\n"
      "{1}.\n\n"
      "1. Install the package `vernier-linuxcnc` and put this folder, `{2}`, beside your INI file.\n"
      "2. `vernier keys -o {2}`: whose images the machine takes. Keep `vernier.key` elsewhere.\n"
      "3. Put the lines of `vernier.ini` into your INI file: `HALFILE = {2}/vernier.hal` last in `[HAL]`, "
      "and `[VERNIER]`.\n"
      "4. Set `CMD_n` and `FB_n` to the signals of your HAL files, and `POSITION` (see there).\n"
      "5. Connect the sensors in `vernier.hal`, where the machine has some.\n"
      "6. Start LinuxCNC and home all joints. `halcmd getp vernier.0.active` is TRUE when the whole "
      "correction is active.\n"
      "7. To use a new image: `vernier upload DIR --to tcp://127.0.0.1:1502 --key vernier.key --confirm`, "
      "while LinuxCNC runs; then\n"
      "   take `--image [VERNIER]IMAGE` out of `vernier.hal`, so that LinuxCNC starts with what is in the "
      "store.\n\n"
      "To remove the component, delete the HALFILE line. The component makes no other change to the "
      "configuration.\n\n"
      "Pins: `man 9 vernier`. More: `tools/docs/linuxcnc.md` (/usr/share/doc/vernier-linuxcnc).\n",
      machine.name, joints, folder);
}

}  // namespace

std::vector<ConfigurationFile> linuxcnc_folder(const model::Machine& machine, const std::string& folder) {
  check_names(machine);
  return {{"vernier.hal", hal_file(machine)},
          {"vernier.ini", ini_lines(machine, folder)},
          {"README.md", readme(machine, folder)}};
}

}  // namespace vernier::exchange
