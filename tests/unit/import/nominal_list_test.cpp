// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a tracker and a separate list of nominal positions.
#include "tools/import/logs/nominal_list.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tools/import/logs/nominal_points.h"
#include "tools/import/tables/survey.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::nominal_list_test {

using namespace vernier::importer;
using testing::HasSubstr;
namespace {

constexpr const char* kMachine =
    R"xml(<machine name="m"><variables><static><k value="0" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600"/><Y rotary="false" min="0" max="400"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X" Y="Y+k*X" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

/// Four points, 1000 and -500 mm from the machine's origin, with their names.
constexpr const char* kPoints =
    "A::Vol::P1, 1000.01, -500, 0\nA::Vol::P2, 1100, -500.01, 0\nA::Vol::P3, 1100, -440, 0.01\nA::Vol::P4, "
    "1030, -420, 0\n";

ImportTable points(bool names) {
  ColumnMap map;
  if (names) add_column(map, "1=point");
  add_column(map, "2=x[mm]");
  add_column(map, "3=y[mm]");
  add_column(map, "4=z[mm]");
  ImportTable table = mapped_table(kPoints, "pts.txt", map);
  finish_tracker(table);
  return table;
}

std::string join(const std::string& list, bool names, NominalTable* result = nullptr) {
  try {
    NominalTable joined =
        with_nominal(points(names), {list, "nom.csv"}, model::parse_machine(kMachine, "m.xml"), 2);
    const std::string text = measurement_csv(joined.table);
    if (result != nullptr) *result = std::move(joined);
    return text;
  } catch (const text::InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

TEST(NominalList, IsJoinedByTheNamesOfThePoints) {
  // Another order, a point more, and another heading of the names.
  NominalTable result;
  EXPECT_EQ(
      join("Punkt;X [mm];Y [mm]\nP4;30;80\nP3;100;60\nP9;5;5\nP2;100;0\nP1;0;0\n", true, &result),
      "X[mm],Y[mm],point,x[mm],y[mm],z[mm]\n0,0,A::Vol::P1,1000.01,-500,0\n"
      "100,0,A::Vol::P2,1100,-500.01,0\n100,60,A::Vol::P3,1100,-440,0.01\n30,80,A::Vol::P4,1030,-420,0\n");
  EXPECT_EQ(result.names, "point");
  EXPECT_EQ(result.unused_lines.size(), 1U);
  ASSERT_TRUE(result.rms_mm.has_value());
  EXPECT_LT(*result.rms_mm, 0.02);  // errors of 0.01 mm in three coordinates
}

/// kPoints with numbers as names, in the order 4, 3, 2, 1.
ImportTable numbered_points(const std::string& heading) {
  ColumnMap map;
  add_column(map, "1=" + heading);
  for (const char* word : {"2=x[mm]", "3=y[mm]", "4=z[mm]"}) add_column(map, word);
  ImportTable table = mapped_table(
      "4, 1030, -420, 0\n3, 1100, -440, 0.01\n2, 1100, -500.01, 0\n1, 1000.01, -500, 0\n", "pts.txt", map);
  finish_tracker(table);
  return table;
}

NominalTable join_numbered(const std::string& heading, const std::string& list,
                           const std::vector<std::string>& columns = {}) {
  return with_nominal(numbered_points(heading), {list, "nom.csv", columns},
                      model::parse_machine(kMachine, "m.xml"), 2);
}

TEST(NominalList, IsJoinedByNumbersBelowHeadingsThatNamePoints) {
  const std::vector<std::size_t> reversed = {3, 2, 1, 0};
  for (const char* heading : {"Punkt", "Nr.", "Pt. No.", "Punkt-Nr", "point"}) {
    const NominalTable result =
        join_numbered("point", std::string(heading) + ";X [mm];Y [mm]\n1;0;0\n2;100;0\n3;100;60\n4;30;80\n");
    EXPECT_EQ(result.names, "point") << heading;
    EXPECT_EQ(result.rows, reversed) << heading;
  }
}

TEST(NominalList, EachFileCanCountThePointsInItsOwnWay) {
  // The list counts from the first position, the tracker from the last one; then a list that counts twice.
  const std::vector<std::size_t> in_order = {0, 1, 2, 3};
  const NominalTable result = join_numbered("point", "Nr;X [mm];Y [mm]\n1;30;80\n2;100;60\n3;100;0\n4;0;0\n");
  EXPECT_EQ(result.rows, in_order);
  EXPECT_EQ(result.names, "");
  EXPECT_EQ(join_numbered("point", "Nr;X [mm];Y [mm]\n1;30;80\n1;100;60\n2;100;0\n2;0;0\n").rows, in_order);
}

TEST(NominalList, TheUserAssignsTheColumnOfTheNames) {
  const std::vector<std::size_t> reversed = {3, 2, 1, 0};
  const std::string list = "Station;X [mm];Y [mm]\n1;0;0\n2;100;0\n3;100;60\n4;30;80\n";
  EXPECT_THROW(join_numbered("point", list), text::InputError);
  const NominalTable result = join_numbered("point", list, {"point=Station"});
  EXPECT_EQ(result.rows, reversed);
  EXPECT_EQ(result.names, "point");
}

TEST(NominalList, IsJoinedByRowNumberWithoutNames) {
  NominalTable result;
  EXPECT_THAT(join("X [mm];Y [mm]\n0;0\n100;0\n100;60\n30;80\n", false, &result),
              testing::StartsWith("X[mm],Y[mm],x[mm],y[mm],z[mm]\n0,0,1000.01,-500,0\n"));
  EXPECT_TRUE(result.names.empty());
}

TEST(NominalList, AListInAnotherOrderIsRefused) {
  EXPECT_THAT(join("X [mm];Y [mm]\n100;0\n0;0\n100;60\n30;80\n", false),
              HasSubstr("from its nominal position after the best rigid motion of all points (joined by row "
                        "number): check the order"));
}

TEST(NominalList, WhatCannotBeJoinedIsNamed) {
  EXPECT_THAT(
      join("X [mm];Y [mm]\n0;0\n100;0\n", false),
      HasSubstr("pts.txt has 4 points, this list has 2 positions, and no column of names joins them. If the "
                "file of points has the names"));
  EXPECT_THAT(join("Punkt;X [mm];Y [mm]\nP4;30;80\nP3;100;60\nP2;100;0\n", true),
              HasSubstr("pts.txt:1: \"A::Vol::P1\": the list of nominal positions (nom.csv) has no point"));
  EXPECT_THAT(join("Punkt;X [mm];Y [mm]\nP1;0;0\nP1;1;0\nP2;100;0\nP3;100;60\nP4;30;80\n", true),
              HasSubstr("nom.csv:3: \"P1\": the list of nominal positions has this point twice"));
  EXPECT_THAT(join("Punkt;Y;X\nP1;0;0\nP2;0;100\nP3;60;100\nP4;80;30\n", true),
              HasSubstr("nom.csv:1: \"X, Y\": the headings of these axes have no unit in the list of nominal "
                        "positions. If this assignment and its units are right, give: --column \"X[mm]=X\" "
                        "--column \"Y[mm]=Y\""));
  EXPECT_THAT(
      join("Punkt;X [mm];Rest\nP1;0;1\nP2;100;1\nP3;100;2\nP4;30;2\n", true),
      HasSubstr("nom.csv:1: \"Y\": the list of nominal positions has no column with the name of these "
                "axes"));
  EXPECT_THAT(join("Punkt\nP1\nP2\nP3\nP4\n", true), HasSubstr("refused: "));
}

TEST(NominalList, DistancesShowThePositionsWithoutAPoint) {
  NominalTable result;
  // The second and the fifth position of the list have no point.
  EXPECT_EQ(join("X [mm];Y [mm]\n0;0\n50;200\n100;0\n100;60\n400;10\n30;80\n", false, &result),
            "X[mm],Y[mm],x[mm],y[mm],z[mm]\n0,0,1000.01,-500,0\n100,0,1100,-500.01,0\n100,60,1100,-440,0.01\n"
            "30,80,1030,-420,0\n");
  EXPECT_TRUE(result.by_distances);
  EXPECT_EQ(result.unused_lines, (std::vector<std::size_t>{3, 6}));
  // A point that agrees with no position: no pairs are made up.
  EXPECT_THAT(join("X [mm];Y [mm]\n0;0\n50;200\n100;0\n100;60\n400;10\n300;80\n", false),
              HasSubstr("the distances between the points do not show which positions have no point. If the "
                        "file of points has the names of the points, read them too"));
}

TEST(NominalList, AnotherUnitOfThePointsIsNamed) {
  const model::Machine machine = model::parse_machine(kMachine, "m.xml");
  ColumnMap map;
  for (const char* word : {"2=x[mm]", "3=y[mm]", "4=z[mm]"}) add_column(map, word);
  ImportTable metres = mapped_table(
      "P1, 1.00001, -0.5, 0\nP2, 1.1, -0.50001, 0\nP3, 1.1, -0.44, 0.00001\nP4, "
      "1.03, -0.42, 0\n",
      "pts.txt", map);
  finish_tracker(metres);
  EXPECT_THAT(
      [&] {
        with_nominal(metres, {"X [mm];Y [mm]\n0;0\n100;0\n100;60\n30;80\n", "nom.csv"}, machine, 2);
      },
      testing::ThrowsMessage<text::InputError>(HasSubstr("With the points in [m] in the place of [mm] they "
                                                         "agree within 0.00829 mm: write x[m], y[m], z[m]")));
}

/// A robot with three joints and links of 100, 80 and 60 mm.
constexpr const char* kRobot =
    R"xml(<machine name="r"><variables><static><k value="0" nominal="0"/></static>
  <machineaxes><joint_1 rotary="true" min="-170" max="170"/><joint_2 rotary="true" min="-170" max="170"/>
  <joint_3 rotary="true" min="-170" max="170"/></machineaxes></variables>
  <transforms><sixdof n="1" X="0" Y="0" Z="100" rX="0" rY="0" rZ="joint_1"/>
  <sixdof n="2" X="80" Y="0" Z="0" rX="0" rY="joint_2" rZ="0"/>
  <sixdof n="3" X="60" Y="0" Z="0" rX="0" rY="joint_3+k" rZ="0"/></transforms></machine>)xml";

TEST(NominalList, JointsMayHaveTheirUsualNames) {
  ImportTable table = points(true);
  const model::Machine machine = model::parse_machine(kRobot, "r.xml");
  const NominalTable joined = with_nominal(
      table, {"Punkt;A1 [deg];A2 [deg];A3 [deg]\nP1;0;0;0\nP2;10;20;30\nP3;20;5;9\nP4;-5;6;70\n", "nom.csv"},
      machine, 1e6);
  EXPECT_THAT(measurement_csv(joined.table),
              testing::StartsWith(
                  "joint_1[deg],joint_2[deg],joint_3[deg],point,x[mm],y[mm],z[mm]\n0,0,0,A::Vol::P1,"));
  EXPECT_EQ(joined.note, "");
  const NominalTable degrees = with_nominal(
      table, {"Punkt;A1;A2;A3\nP1;0;0;0\nP2;10;20;30\nP3;20;5;9\nP4;-5;6;70\n", "nom.csv"}, machine, 1e6);
  EXPECT_EQ(measurement_csv(degrees.table), measurement_csv(joined.table));
  EXPECT_THAT(degrees.note, testing::HasSubstr("(A1 ...) have no unit: they are read in degrees"));
  // These can be radians or degrees, and with this tolerance the points do not show which.
  NominalList bare{"Punkt;A1;A2;A3\nP1;0;0;0\nP2;1;0.2;0.3\nP3;2;0.5;0.9\nP4;-0.5;0.6;1.7\n", "nom.csv"};
  std::string refusal;
  try {
    with_nominal(table, bare, machine, 1e6);
  } catch (const text::InputError& error) {
    refusal = error.what();
  }
  EXPECT_THAT(refusal,
              HasSubstr("nom.csv:1: \"joint_1, joint_2, joint_3\": the list of nominal positions has no "
                        "column with the name of these axes, and its columns A1 .. A3 have no unit. If "
                        "this assignment and its units are right, give: --column \"joint_1[rad]=A1\""));
  // The assignment of the user is that of `import table`.
  bare.columns = {"joint_1[deg]=A1", "A2=joint_2[deg]", "joint_3[deg]=4"};
  EXPECT_THAT(measurement_csv(with_nominal(table, bare, machine, 1e6).table),
              testing::StartsWith("joint_1[deg],joint_2[deg],joint_3[deg],point,x[mm],y[mm],z[mm]\n0,0,0,"));
  bare.columns = {"joint_1[deg]=A7"};
  bare.option = "--nominal-column";
  EXPECT_THAT([&] { with_nominal(table, bare, machine, 1e6); },
              testing::ThrowsMessage<text::InputError>(
                  HasSubstr("--nominal-column \"joint_1[deg]=A7\": the sheet has no column")));
}

/// Points of the robot at these joints, 1000, -500 and 300 mm from its origin.
ImportTable points_at(const std::vector<std::array<double, 3>>& joints, const model::Machine& machine) {
  ImportTable poses{"pts.txt", {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const auto& row : joints) values.push_back(row[k]);
    poses.add(machine.axes[k].name, "deg", values);
  }
  for (std::size_t i = 0; i < joints.size(); ++i) poses.line.push_back(i + 1);
  const model::Poses nominal = nominal_poses(poses, machine);
  ImportTable table{"pts.txt", {}, poses.line};
  constexpr std::array<double, 3> kAway_mm = {1000, -500, 300};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (std::size_t i = 0; i < joints.size(); ++i)
      values.push_back(nominal.position(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) +
                       kAway_mm[k]);
    table.add(std::string(1, "xyz"[k]), "mm", values);
  }
  return table;
}

/// The points with one of them moved along x.
ImportTable moved(ImportTable table, std::size_t row, double by_mm) {
  std::string& cell = table.columns.front().cells[row];
  cell = fmt::format("{:.4f}", std::stod(cell) + by_mm);
  return table;
}

TEST(NominalList, AJointThatTheListCountsOtherwiseIsNamed) {
  // The control counts A2 in the other direction, and A3 from 90 deg on. The tool point is beside the plane
  // of the arm: the mirror image of the arm is another one.
  std::string robot = kRobot;
  robot.insert(robot.find("</transforms>"), R"(<sixdof n="4" X="50" Y="35" Z="20" rX="0" rY="0" rZ="0"/>)");
  const model::Machine machine = model::parse_machine(robot, "r.xml");
  const std::vector<std::array<double, 3>> joints = {{0, 10, 20},  {30, -40, 55},  {-60, 25, -35},
                                                     {80, 60, 10}, {-20, -15, 70}, {45, 35, -80}};
  const ImportTable table = points_at(joints, machine);
  std::string list = "A1 [deg];A2 [deg];A3 [deg]\n", plain = list, swapped = list;
  for (const auto& [one, two, three] : joints) {
    list += fmt::format("{};{};{}\n", one, -two, three - 90);
    plain += fmt::format("{};{};{}\n", one, two, three);
    swapped += fmt::format("{};{};{}\n", two, one, three);
  }
  NominalList nominal{list, "nom.csv", {}, "--nominal-column"};
  EXPECT_THAT(
      [&] { with_nominal(table, nominal, machine, 2); },
      testing::ThrowsMessage<text::InputError>(testing::AllOf(
          HasSubstr("With joint_2 = -A2 [deg], joint_3 = A3 [deg]+90 all points agree within "),
          HasSubstr("the list counts these axes in the other direction"),
          HasSubstr(
              "give: --nominal-column \"joint_1[deg]=A1 [deg]\" --nominal-column \"joint_2[deg]=-A2 [deg]\" "
              "--nominal-column \"joint_3[deg]=A3 [deg]+90\""))));
  // A tolerance with which everything agrees is no reason to say nothing.
  EXPECT_THAT(with_nominal(table, nominal, machine, 100).note, HasSubstr("With joint_2 = -A2 [deg]"));
  // Errors of the robot above the tolerance: the reading that is ten times better is named all the same.
  EXPECT_THAT(
      [&] { with_nominal(moved(table, 1, 12), nominal, machine, 2); },
      testing::ThrowsMessage<text::InputError>(HasSubstr("With joint_2 = -A2 [deg], joint_3 = A3 [deg]+90")));
  EXPECT_THAT(
      [&] {
        with_nominal(moved(table, 1, 12), {plain, "nom.csv"}, machine, 2);
      },
      testing::ThrowsMessage<text::InputError>(HasSubstr("give --tolerance 2.8")));
  nominal.columns = {"joint_1[deg]=A1 [deg]", "joint_2[deg]=-A2 [deg]", "joint_3[deg]=A3 [deg]+90"};
  const std::string right = measurement_csv(with_nominal(table, {plain, "nom.csv"}, machine, 2).table);
  EXPECT_EQ(measurement_csv(with_nominal(table, nominal, machine, 2).table), right);
  nominal.columns = {"joint_1[deg]=1", "joint_2[deg]=-2", "joint_3[deg]=3+90"};  // numbers of the columns
  EXPECT_EQ(measurement_csv(with_nominal(table, nominal, machine, 2).table), right);
  // A heading that ends with a sign and a number is a heading.
  std::string odd = plain;
  odd.replace(odd.find("A2 [deg]"), 8, "Achse-2");
  NominalList named{
      odd, "nom.csv", {"joint_1[deg]=A1 [deg]", "joint_2[deg]=Achse-2", "joint_3[deg]=A3 [deg]"}};
  EXPECT_EQ(measurement_csv(with_nominal(table, named, machine, 2).table), right);
  // Joints in another order have no such counting.
  EXPECT_THAT(
      [&] {
        with_nominal(table, {swapped, "nom.csv"}, machine, 2);
      },
      testing::ThrowsMessage<text::InputError>(HasSubstr("check the order and the names")));
}

}  // namespace
}  // namespace vernier::nominal_list_test
