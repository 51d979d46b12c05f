// SPDX-License-Identifier: GPL-3.0-or-later
// A reflector at an unknown place on the tool of a robot is a part of the set-up, and no error to correct.
// Nor are another zero of a joint, another sign, and readings that slipped by a row.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/commands/shell_folder.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::reflector_test {

using testing::HasSubstr;
using testing::Not;
namespace {

constexpr double kReflector_mm = 40, kU_mm = 0.02;

/// 60 points of a UR10e with zero errors of its joints, and the reflector beside the tool point. `twist_deg`:
/// error of the twist from joint 1 to 2, which no zero of a joint expresses.
std::string survey(std::string robot, double reflector_mm = kReflector_mm, double twist_deg = 0) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(robot.find(from), std::string::npos) << from;
    robot.replace(robot.find(from), from.size(), to);
  };
  replace("<TPX value=\"0\"", fmt::format("<TPX value=\"{}\"", reflector_mm));
  replace("<al1 value=\"0\"", fmt::format("<al1 value=\"{}\"", twist_deg));
  replace("<th2 value=\"0\"", "<th2 value=\"0.03\"");
  replace("<th5 value=\"0\"", "<th5 value=\"-0.04\"");
  const model::Machine machine = model::parse_machine(robot, "true.xml");
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(-1, 1);
  std::normal_distribution<double> noise(0, kU_mm);
  std::string text = "J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg],x[mm],y[mm],z[mm],u[um]\n";
  std::vector<std::string> rows;
  for (int i = 0; i < 60; ++i) {
    std::string row;
    for (const auto& [middle, half] :
         {std::pair(0, 120), {-80, 40}, {70, 40}, {-75, 45}, {-80, 40}, {0, 150}})
      row += fmt::format("{:.5f},", middle + half * share(random));
    rows.push_back(row);
    text += row + "0,0,0,20\n";
  }
  const model::Measurement m = model::parse_measurement(text, "true.csv", machine);
  const Eigen::VectorXd read = model::predict(machine, m);
  std::string measured = text.substr(0, text.find('\n') + 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measured += rows[i];
    for (std::size_t k = 0; k < 3; ++k)
      measured += fmt::format("{:.4f},", read[static_cast<Eigen::Index>(3 * i + k)] + noise(random));
    measured += "20\n";
  }
  return measured;
}

struct Reflector : commands_test::ShellFolder {
  Reflector() : ShellFolder("reflector") {
    const std::string robot = text::read_file(VERNIER_SOURCE_DIR "/tables/machines/ur10e.xml");
    text::write_file(folder + "/robot.xml", robot);
    text::write_file(folder + "/points.csv", survey(robot));
  }
};

TEST_F(Reflector, IsNamedBesideAnOffsetOfTheToolPoint) {
  ASSERT_EQ(run("vernier diagnose robot.xml points.csv --json d.json"), 0) << said;
  const auto json = nlohmann::json::parse(text::read_file(folder + "/d.json"));
  EXPECT_THAT(json["explanation"].get<std::string>(),
              HasSubstr("vernier set robot.xml --reflector -o NEW.xml"));
  ASSERT_EQ(run("vernier set robot.xml --reflector -o with.xml"), 0) << said;
  EXPECT_EQ(run("vernier set with.xml --reflector -o twice.xml"), 1) << said;
  ASSERT_EQ(run("vernier diagnose with.xml points.csv --json d.json"), 0) << said;
  const auto declared = nlohmann::json::parse(text::read_file(folder + "/d.json"));
  EXPECT_EQ(declared["verdict"], "consistent");
  EXPECT_THAT(declared["explanation"].get<std::string>(), Not(HasSubstr("--reflector")));
}

TEST_F(Reflector, IsEstimatedAndNotCorrected) {
  ASSERT_EQ(run("vernier set robot.xml --reflector -o with.xml && vernier fit with.xml points.csv -o f.xml"),
            0)
      << said;
  const model::Machine fitted = model::parse_machine(text::read_file(folder + "/f.xml"), "f.xml");
  ASSERT_EQ(fitted.tool_shifts.size(), 1U);
  EXPECT_NEAR(fitted.tool_shifts.front().value[0], kReflector_mm, 0.1);
  // What a correction moves the axes for: the zero errors alone.
  ASSERT_EQ(run("vernier pose f.xml --at J1=0,J2=-80,J3=70,J4=-75,J5=-80,J6=0 --json p.json"), 0) << said;
  const auto pose = nlohmann::json::parse(text::read_file(folder + "/p.json"));
  double largest_um = 0;
  for (const double one : pose["deviation_um"]) largest_um = std::max(largest_um, std::abs(one));
  EXPECT_LT(largest_um, 2000);
}

// A correction acts at the tool point: the loop with the tool point at the reflector is the one that these
// rows judge.
TEST_F(Reflector, IsTheToolPointOfTheSimulatedLoop) {
  text::write_file(folder + "/points.csv", survey(text::read_file(folder + "/robot.xml"), 150, 0.1));
  ASSERT_EQ(
      run("vernier set robot.xml --reflector -o with.xml && vernier improve with.xml points.csv -o v --yes "
          "--json v.json"),
      0)
      << said;
  EXPECT_THAT(said, HasSubstr("with the tool point at the reflector: rms of fit rows"));
  EXPECT_THAT(said, Not(HasSubstr("the loop leaves")));
  EXPECT_THAT(text::read_file(folder + "/v.json"), HasSubstr("\"tool_point\": \"reflector\""));
}

// With joint 5 near 0 the axes of joints 4 and 6 are nearly one line: the message names the row and this
// reason.
TEST_F(Reflector, CorrectionNearASingularPoseNamesTheRow) {
  std::string robot = text::read_file(folder + "/robot.xml");
  robot.replace(robot.find("<J4 "), 4, "<J4 maxcorrection=\"5\" ");
  text::write_file(folder + "/limited.xml", robot);
  ASSERT_EQ(run("vernier set limited.xml al4=0.2 -o errors.xml"), 0) << said;
  std::string rows = "J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg]\n";
  for (int i = 0; i < 9; ++i)
    rows += fmt::format("{},-80,70,-75,{},{}\n", 10 * i, i == 6 ? -0.01 : -80 + i, 5 * i);
  text::write_file(folder + "/list.csv", rows);
  ASSERT_EQ(run("vernier correct errors.xml list.csv --rotary -o c.csv"), 2) << said;
  EXPECT_THAT(said, HasSubstr("list.csv:8; 1 of 9 positions exceed a maxcorrection (line 8)"));
  EXPECT_THAT(said, HasSubstr("near a singular pose"));
  EXPECT_THAT(said, HasSubstr("no file is written"));
}

/// The table with the numbers of a column changed.
std::string with_column(const std::string& table, std::size_t column, double factor, double add) {
  std::string text;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells = text::parts_of(line, ',');
    if (!text.empty()) cells[column] = fmt::format("{:.5f}", factor * std::stod(cells[column]) + add);
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

TEST_F(Reflector, AnotherZeroOrSignOfAJointIsSaidByTheFit) {
  ASSERT_EQ(run("vernier set robot.xml --reflector -o with.xml"), 0) << said;
  ASSERT_EQ(run("vernier fit with.xml points.csv"), 0) << said;
  EXPECT_THAT(said, Not(HasSubstr("is no error of the machine")));
  const std::string table = text::read_file(folder + "/points.csv");
  text::write_file(folder + "/zero.csv", with_column(table, 2, 1, -90));
  ASSERT_EQ(run("vernier fit with.xml zero.csv --json f.json"), 0) << said;
  EXPECT_THAT(said, HasSubstr("an angle so near to 90 deg is no error of the machine"));
  EXPECT_THAT(said, HasSubstr("with J3 + 90 deg in the readings"));
  EXPECT_THAT(text::read_file(folder + "/f.json"), HasSubstr("with J3 + 90 deg"));
  text::write_file(folder + "/sign.csv", with_column(table, 5, -1, 0));
  ASSERT_EQ(run("vernier fit with.xml sign.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("the other sign of J6"));
}

TEST_F(Reflector, ReadingsThatSlippedByARowAreNamed) {
  ASSERT_EQ(run("vernier set robot.xml --reflector -o with.xml"), 0) << said;
  std::istringstream lines(text::read_file(folder + "/points.csv"));
  std::string line, slipped, joints;
  std::getline(lines, slipped);
  while (std::getline(lines, line)) {
    const auto at =
        std::string(line).rfind(',', line.rfind(',', line.rfind(',', line.rfind(',') - 1) - 1) - 1);
    slipped += joints.empty() ? "" : "\n" + joints + line.substr(at);
    joints = line.substr(0, at);
  }
  text::write_file(folder + "/slipped.csv", slipped + "\n");
  EXPECT_EQ(run("vernier fit with.xml slipped.csv -o s.xml"), 2) << said;
  EXPECT_THAT(said, HasSubstr("if each reading moves to the row after its own"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/s.xml"));
}

TEST_F(Reflector, IsDeclaredInANewMachineFile) {
  ASSERT_EQ(
      run("vernier new gantry --axis X:0:200 --axis Y:0:200 --reflector -o new.xml --measurements s.csv"), 0)
      << said;
  EXPECT_EQ(model::parse_machine(text::read_file(folder + "/new.xml"), "new.xml").tool_shifts.size(), 1U);
}

}  // namespace
}  // namespace vernier::reflector_test
