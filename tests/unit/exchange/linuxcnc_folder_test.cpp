// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/linuxcnc_folder.h"

#include <gtest/gtest.h>

#include "tools/model/machine_reader.h"

namespace vernier::linuxcnc_folder_test {

using namespace vernier::exchange;
using namespace vernier::model;
using namespace vernier::text;
namespace {

Machine machine_with(const std::string& axes, const std::string& inputs = "") {
  return parse_machine(
      "<machine name=\"mill\"><variables><machineaxes>" + axes + "</machineaxes><inputs>" + inputs +
          "</inputs></variables><transforms branch=\"tool\"><sixdof n=\"1\"/></transforms></machine>",
      "mill.xml");
}

std::string text_of(const std::vector<ConfigurationFile>& files, const std::string& name) {
  for (const ConfigurationFile& file : files)
    if (file.name == name) return file.text;
  return {};
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(LinuxcncFolder, LoadsTheAxesAsJointsAndTheInputsAsPins) {
  const auto files =
      linuxcnc_folder(machine_with("<X min=\"0\" max=\"1\"/><A rotary=\"true\" min=\"0\" max=\"1\"/>",
                                   "<T_column unit=\"degC\" reference=\"20\"/>"),
                      "vernier");
  const std::string hal = text_of(files, "vernier.hal");
  EXPECT_TRUE(holds(hal, "\nloadrt vernier axes=X,A inputs=T_column units=[TRAJ]LINEAR_UNITS\n"));
  EXPECT_TRUE(holds(hal, "net vernier-cmd-1 joint.1.motor-pos-cmd => vernier.0.joint.1.cmd-in\n"));
  EXPECT_TRUE(holds(hal, "vernier.0.input.T_column   # degC, reference 20\n")) << hal;
  EXPECT_TRUE(holds(hal, "setp vernier.0.joint.1.max-velocity [JOINT_1]MAX_VELOCITY\n"));
  EXPECT_FALSE(holds(hal, "joint.2")) << "no third joint";
  EXPECT_TRUE(holds(text_of(files, "vernier.ini"), "CMD_1 = a-pos-cmd\nFB_1 = a-pos-fb\n"));
  EXPECT_TRUE(holds(text_of(files, "vernier.ini"), "IMAGE = vernier/image\n"));
  EXPECT_TRUE(holds(text_of(files, "README.md"), "joint 0 = X, joint 1 = A"));
}

TEST(LinuxcncFolder, NamesLimitsThatRefuseBeforeTheStart) {
  const auto ini = [](const std::string& axes) {
    return text_of(linuxcnc_folder(machine_with(axes), "v"), "vernier.ini");
  };
  EXPECT_TRUE(holds(ini("<X min=\"-1\" max=\"400\" maxcorrection=\"0.3\"/>"),
                    "#   [JOINT_0] MIN_LIMIT = -0.7, MAX_LIMIT = 399.7\n"));
  EXPECT_FALSE(holds(ini("<X min=\"0\" max=\"400\"/>"), "narrower")) << "any correction";
}

TEST(LinuxcncFolder, SaysWhichAxesTurnWhereTheirNamesDoNot) {
  const auto hal = [](const std::string& axes) {
    return text_of(linuxcnc_folder(machine_with(axes), "v"), "vernier.hal");
  };
  EXPECT_TRUE(holds(hal("<J1 rotary=\"true\" min=\"0\" max=\"1\"/><C rotary=\"true\" min=\"0\" max=\"1\"/>"),
                    "axes=J1,C rotary=J1,C units="));
  EXPECT_TRUE(holds(hal("<X min=\"0\" max=\"1\"/><A min=\"0\" max=\"1\"/>"), "axes=X,A rotary=none units="));
}

TEST(LinuxcncFolder, RefusesWhatTheComponentCannotTake) {
  std::string nine;
  for (const char name : std::string("XYZUVWABC")) nine += std::string("<") + name + " min=\"0\" max=\"1\"/>";
  EXPECT_THROW(linuxcnc_folder(machine_with(nine), "v"), InputError);
  EXPECT_THROW(linuxcnc_folder(machine_with("<X min=\"0\" max=\"1\"/>",
                                            "<a_name_of_more_than_23_letters unit=\"\" reference=\"0\"/>"),
                               "v"),
               InputError);
}

}  // namespace
}  // namespace vernier::linuxcnc_folder_test
