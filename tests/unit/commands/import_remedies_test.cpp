// SPDX-License-Identifier: GPL-3.0-or-later
// The remedies that an import prints: as a user pastes them, with the options of the first call.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "tests/unit/commands/shell_folder.h"
#include "tools/sheet/workbook_writer.h"
#include "tools/text/files.h"

namespace vernier::import_remedies_test {

using testing::HasSubstr;
namespace {

namespace fs = std::filesystem;

constexpr const char* kMachine =
    R"xml(<machine name="m"><variables><static><k value="0" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600"/><Y rotary="false" min="0" max="400"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X" Y="Y+k*X" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

struct ImportRemedies : commands_test::ShellFolder {
  ImportRemedies() : ShellFolder("import_remedies") { text::write_file(folder + "/m.xml", kMachine); }

  /// The last command in the output, with a number for its POSITION.
  std::string remedy() const {
    std::string call = said.substr(said.rfind("vernier import"));
    for (std::size_t at = 0; (at = call.find("POSITION")) != std::string::npos;) call.replace(at, 8, "400");
    return call;
  }
};

TEST_F(ImportRemedies, OfATableKeepTheOptionsOfTheCall) {
  fs::copy_file(VERNIER_SOURCE_DIR "/tests/data/sheets/survey.xlsx", folder + "/a survey.xlsx");
  ASSERT_EQ(run("vernier import table 'a survey.xlsx' --sheet Messung --leave Temp. --set 'u[um]=1,5' "
                "--machine m.xml -o read.csv"),
            1)
      << said;
  EXPECT_THAT(said,
              HasSubstr("vernier import table \"a survey.xlsx\" --leave Temp. --set \"u[um]=1,5\" --sheet "
                        "Messung --machine m.xml --set \"Y[mm]=POSITION\" -o read.csv"));
  ASSERT_EQ(run(remedy()), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"), testing::StartsWith("X[mm],x[mm],run,u[um],Y[mm]\n"));
}

TEST_F(ImportRemedies, OfDistancesBetweenPointsAskForThePositions) {
  text::write_file(folder + "/square.csv", "Strecke;Soll;Ist\nAB;60;60,1\nBC;80;80,1\nAC;100;99,9\n");
  ASSERT_EQ(run("vernier import table square.csv --machine m.xml --set 'u[mm]=0,02' -o read.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("square.csv:1: \"A, B, C\": the rows are distances between named points"));
  EXPECT_THAT(said, testing::Not(HasSubstr("--column")));
  std::string call = said.substr(said.rfind("vernier import"));
  for (const auto& [open, position] :
       {std::pair("A=X,Y", "A=0,0"), std::pair("B=X,Y", "B=60,0"), std::pair("C=X,Y", "C=60,80")}) {
    ASSERT_NE(call.find(open), std::string::npos) << call;
    call.replace(call.find(open), std::string(open).size(), position);
  }
  ASSERT_EQ(run(call), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("point,X[mm],Y[mm],distance[mm],from,u[mm]\nA,0,0,,,0.02\n"));
  // A list of the positions, and corners in another order.
  text::write_file(folder + "/list.csv", "Punkt;X [mm];Y [mm]\nA;0;0\nC;60;0\nB;60;80\n");
  ASSERT_EQ(run("vernier import table square.csv --machine m.xml --nominal list.csv -o other.csv"), 1)
      << said;
  EXPECT_THAT(said,
              HasSubstr("the nominal distance of A and B is 60 mm, and the stated points are 100 mm apart"));
  EXPECT_THAT(said, HasSubstr("if the positions of B and C are exchanged, all distances agree"));
  ASSERT_EQ(run("vernier import table square.csv --nominal list.csv -o other.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("\"--nominal\": this option requires --machine"));
}

TEST_F(ImportRemedies, OfAWorkbookReadEachOfItsSheets) {
  const auto rows = [](const std::string& axis) {
    return std::vector<std::vector<std::string>>{
        {axis + " [mm]", "Abw. " + axis + " [um]"}, {"0", "1"}, {"50", "2"}, {"100", "3"}};
  };
  text::write_file(
      folder + "/mill.xlsx",
      sheet::workbook_of({{"Achse X", rows("X")}, {"Achse Y", rows("Y")}, {"Achse Z", rows("Z")}}));
  ASSERT_EQ(run("vernier import table mill.xlsx -o x.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("which are not read: \"Achse Y\", \"Achse Z\"; to read them, give: "));
  const std::size_t first = said.find("vernier import table mill.xlsx --sheet"), end = said.find(';', first);
  ASSERT_NE(end, std::string::npos) << said;
  const std::string second = said.substr(end + 2, said.find('\n', end) - end - 2);
  ASSERT_EQ(run(said.substr(first, end - first)), 0) << said;
  EXPECT_THAT(said, testing::Not(HasSubstr("more sheets")));
  ASSERT_EQ(run(second), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/mill_Achse_Y.csv"), testing::StartsWith("Y[mm],y[mm]\n"));
  EXPECT_THAT(text::read_file(folder + "/mill_Achse_Z.csv"), testing::StartsWith("Z[mm],z[mm]\n"));
}

/// A robot with two joints, and a table that has its joints under other names.
constexpr const char* kArm = R"xml(<machine name="arm"><variables><static><k value="0" nominal="0"/></static>
  <machineaxes><J1 rotary="true" min="-180" max="180"/><J2 rotary="true" min="-180" max="180"/></machineaxes></variables>
  <transforms><sixdof n="1" rZ="J1"/><sixdof n="2" X="300+k" rZ="J2"/><sixdof n="3" X="200"/></transforms></machine>)xml";

TEST_F(ImportRemedies, OfARobotProposeTheAssignmentOfItsJoints) {
  text::write_file(folder + "/arm.xml", kArm);
  text::write_file(folder + "/log.csv", "q1,q2,x [mm],y [mm]\n10,20,1,2\n11,21,3,4\n12,25,5,6\n");
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml -o read.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("--column \"J1[deg]=q1\" --column \"J2[deg]=q2\" -o read.csv"));
  ASSERT_EQ(run(remedy()), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("J1[deg],J2[deg],x[mm],y[mm]\n10,20,"));
}

TEST_F(ImportRemedies, OfARobotWithoutUnitsAreOneCall) {
  text::write_file(folder + "/arm.xml", kArm);
  for (const char* const head : {"pose,A1,A2,X,Y,Z\n", "pose,a1,a2,x,y,z\n"})
    for (const char* const unit : {"", " --unit deg", " --unit mm"}) {
      text::write_file(folder + "/log.csv",
                       std::string(head) + "1,10,20,1,2,3\n2,11,21,3,4,5\n3,12,25,5,6,7\n");
      ASSERT_EQ(run(std::string("vernier import table log.csv --machine arm.xml -o read.csv") + unit), 1)
          << said;
      ASSERT_EQ(run(remedy()), 0) << said;
      EXPECT_THAT(text::read_file(folder + "/read.csv"),
                  testing::StartsWith("pose,J1[deg],J2[deg],x[mm],y[mm],z[mm]\n1,10,20,"));
    }
}

TEST_F(ImportRemedies, TheUnitOfThePointBesideJointsWithUnitsIsTaken) {
  text::write_file(folder + "/arm.xml", kArm);
  text::write_file(folder + "/log.csv", "A1 [deg],A2 [deg],x,y,z\n10,20,1,2,3\n11,21,3,4,5\n12,25,5,6,7\n");
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml -o read.csv"), 1) << said;
  ASSERT_EQ(run(remedy()), 0) << said;
  const std::string read = text::read_file(folder + "/read.csv");
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml --unit mm -o read.csv"), 0) << said;
  EXPECT_EQ(text::read_file(folder + "/read.csv"), read);
}

TEST_F(ImportRemedies, JointsWithTheNumbersAndUnitsOfTheAxesAreRead) {
  text::write_file(folder + "/arm.xml", kArm);
  text::write_file(folder + "/log.csv", "A1 [deg],A2 [deg],x [mm],y [mm]\n10,20,1,2\n11,21,3,4\n12,25,5,6\n");
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml -o read.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("are the axes of the machine, by their numbers: J1=A1 [deg], J2=A2 [deg]"));
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("J1[deg],J2[deg],x[mm],y[mm]\n10,20,"));
}

/// Poses of the arm under joints A1 and A2: the points that its nominal machine reaches, rounded.
std::string poses_of_arm(const std::string& unit, double factor) {
  std::string csv = "A1 [" + unit + "],A2 [" + unit + "],x [mm],y [mm],z [mm]\n";
  for (int i = 0; i < 20; ++i) {
    const double a = (i * 67 % 290) - 145.13, b = (i * 41 % 250) - 125.21, rad = std::numbers::pi / 180;
    csv += fmt::format("{:.5f},{:.5f},{:.4f},{:.4f},0\n", factor * a, factor * b,
                       300 * std::cos(a * rad) + 200 * std::cos((a + b) * rad),
                       300 * std::sin(a * rad) + 200 * std::sin((a + b) * rad));
  }
  return csv;
}

/// The joints of the same poses as a controller logs them, and the points as a tracker lists them.
struct LogAndList {
  std::string log, list;
};

LogAndList log_and_list(const std::string& head, double factor) {
  LogAndList made{head + "\n", ""};
  for (int i = 0; i < 20; ++i) {
    const double a = (i * 67 % 290) - 145.13, b = (i * 41 % 250) - 125.21, rad = std::numbers::pi / 180;
    const double x = 300 * std::cos(a * rad) + 200 * std::cos((a + b) * rad),
                 y = 300 * std::sin(a * rad) + 200 * std::sin((a + b) * rad);
    made.log += fmt::format("P{};{:.5f};{:.5f};{:.3f};{:.3f};0.000\n", i + 1, factor * a, factor * b, x, y);
    // Another frame, and deviations of a robot.
    made.list += fmt::format("{:.4f}\t{:.4f}\t{:.4f}\n", 900 - y + 0.3 * std::sin(7 * i), 400 + x,
                             50 + 0.3 * std::cos(5 * i));
  }
  return made;
}

/// A robot whose joints have names of their own.
std::string own_names() {
  std::string arm = kArm;
  for (const auto& [name, own] : {std::pair("J1", "turret"), std::pair("J2", "elbow")})
    for (std::size_t at = 0; (at = arm.find(name, at)) != std::string::npos;) arm.replace(at, 2, own);
  return arm;
}

TEST_F(ImportRemedies, OfAListOfPositionsIsOneCallForBothFiles) {
  text::write_file(folder + "/own.xml", own_names());
  const auto [log, list] = log_and_list("Name;A1;A2;X;Y;Z", 1);
  text::write_file(folder + "/log.csv", log);
  text::write_file(folder + "/list.txt", list);
  const std::string call = "vernier import tracker list.txt --nominal log.csv --machine own.xml -o read.csv ";
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said,
              HasSubstr("--column \"1=x[mm]\" --column \"2=y[mm]\" --column \"3=z[mm]\" --nominal-column "
                        "\"turret[deg]=A1\" --nominal-column \"elbow[deg]=A2\" -o read.csv"));
  ASSERT_EQ(run(remedy()), 0) << said;
  const std::string read = text::read_file(folder + "/read.csv");
  EXPECT_THAT(read, testing::StartsWith("turret[deg],elbow[deg],x[mm],y[mm],z[mm]\n-145.13000,"));
  // With the columns of the points, all axes are named together.
  ASSERT_EQ(run(call + "--column 1=x[mm] --column 2=y[mm] --column 3=z[mm]"), 1) << said;
  EXPECT_THAT(said, HasSubstr("log.csv:1: \"turret, elbow\": the list of nominal positions has no column"));
  EXPECT_THAT(said, HasSubstr("the joints are in [deg]"));
  ASSERT_EQ(run(remedy()), 0) << said;
  EXPECT_EQ(text::read_file(folder + "/read.csv"), read);
  // One of the columns is assigned: the call has the others too.
  ASSERT_EQ(run(call + "--column 1=x[mm] --column 2=y[mm] --column 3=z[mm] --nominal-column elbow[deg]=A2"),
            1);
  EXPECT_THAT(said, HasSubstr("\"turret\": the list of nominal positions"));
  EXPECT_THAT(said, HasSubstr("--nominal-column \"elbow[deg]=A2\""));
  ASSERT_EQ(run(remedy()), 0) << said;
  EXPECT_EQ(text::read_file(folder + "/read.csv"), read);
  // Names that say nothing beside other numbers: the user states the headings.
  text::write_file(folder + "/log.csv", log_and_list("Name;one;two;X;Y;Z", 1).log);
  ASSERT_EQ(run(call + "--column 1=x[mm] --column 2=y[mm] --column 3=z[mm]"), 1) << said;
  EXPECT_THAT(said, HasSubstr("a heading of the list in the place of HEADING (Name, one, two, X, Y, Z)"));
  std::string stated = remedy();
  for (const char* const heading : {"one", "two"})
    stated.replace(stated.find("HEADING"), std::string("HEADING").size(), heading);
  ASSERT_EQ(run(stated), 0) << said;
  EXPECT_EQ(text::read_file(folder + "/read.csv"), read);
}

TEST_F(ImportRemedies, OfJointsInRadiansNameTheUnit) {
  for (const bool own : {false, true}) {
    text::write_file(folder + "/arm.xml", own ? own_names() : std::string(kArm));
    const std::string first = own ? "turret" : "J1", second = own ? "elbow" : "J2";
    const auto [log, list] = log_and_list("Name;A1;A2;X;Y;Z", std::numbers::pi / 180);
    text::write_file(folder + "/log.csv", log);
    text::write_file(folder + "/list.txt", list);
    const std::string call =
        "vernier import tracker list.txt --column 1=x[mm] --column 2=y[mm] --column 3=z[mm] --nominal "
        "log.csv "
        "--machine arm.xml -o read.csv";
    ASSERT_EQ(run(call), 1) << said;
    EXPECT_THAT(said, HasSubstr("the joints are in [rad]"));
    ASSERT_EQ(run(remedy()), 0) << said;
    const std::string read = text::read_file(folder + "/read.csv");
    EXPECT_THAT(read, testing::StartsWith(first + "[rad]," + second + "[rad],x[mm]"));
    // The user states the wrong unit: the points show it.
    ASSERT_EQ(
        run(call + fmt::format(" --nominal-column {}[deg]=A1 --nominal-column {}[deg]=A2", first, second)),
        1);
    EXPECT_THAT(said, HasSubstr("In radians the points agree within "));
    EXPECT_THAT(said, HasSubstr("write [rad], give: "));
    EXPECT_THAT(said, testing::Not(HasSubstr("--tolerance")));
    ASSERT_EQ(run(remedy()), 0) << said;
    EXPECT_EQ(text::read_file(folder + "/read.csv"), read);
    // The same in the headings of the list.
    text::write_file(folder + "/log.csv",
                     log_and_list("Name;A1 [deg];A2 [deg];X;Y;Z", std::numbers::pi / 180).log);
    ASSERT_EQ(run(call + (own ? " --nominal-column turret=2 --nominal-column elbow[deg]=3" : "")), 1) << said;
    EXPECT_THAT(said,
                HasSubstr("write [rad] in the place of [deg] in the headings of log.csv (A1 [deg], A2"));
    text::write_file(folder + "/log.csv",
                     log_and_list("Name;A1 [rad];A2 [rad];X;Y;Z", std::numbers::pi / 180).log);
    ASSERT_EQ(run(call + (own ? " --nominal-column turret=2 --nominal-column elbow=3" : "")), 0) << said;
  }
}

TEST_F(ImportRemedies, OfPointsInMetresAreOneCall) {
  text::write_file(folder + "/arm.xml", std::string(kArm));
  const auto [log, list] = log_and_list("Name;A1 [deg];A2 [deg];X;Y;Z", 1);
  text::write_file(folder + "/log.csv", log);
  text::write_file(folder + "/list.txt", list);
  // A list in mm that is said to be in m
  const std::string call = "vernier import tracker list.txt --nominal log.csv --machine arm.xml -o read.csv ";
  const std::string rest = " --nominal-column J1=2 --nominal-column J2=3";
  ASSERT_EQ(run(call + "--column 1=x[m] --column 2=y[m] --column 3=z[m]" + rest), 1) << said;
  EXPECT_THAT(said, HasSubstr("With the points in [mm] in the place of [m] they agree within "));
  EXPECT_THAT(said, HasSubstr("write x[mm], y[mm], z[mm], give: vernier import tracker list.txt"));
  EXPECT_THAT(remedy(), HasSubstr("--nominal-column"));
  ASSERT_EQ(run(remedy()), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("J1[deg],J2[deg],x[mm],y[mm],z[mm]"));
  // A map file states the columns: no call can change it.
  text::write_file(folder + "/points.map", "column 1 = x[m]\ncolumn 2 = y[m]\ncolumn 3 = z[m]\n");
  ASSERT_EQ(run(call + "--map points.map" + rest), 1) << said;
  EXPECT_THAT(said, HasSubstr("write x[mm], y[mm], z[mm]"));
  EXPECT_THAT(said, testing::Not(HasSubstr(", give: ")));
}

TEST_F(ImportRemedies, OfALogNameThePositionThatTheControlComputed) {
  text::write_file(folder + "/own.xml", own_names());
  text::write_file(folder + "/log.csv", log_and_list("Name;A1;A2;X;Y;Z", 1).log);
  text::write_file(folder + "/list.txt", log_and_list("", 1).list);
  const std::string call = "vernier import table log.csv --machine own.xml -o read.csv";
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said, HasSubstr("the control probably computed it from the joints, and it is no measurement"));
  // The call for the points of another file.
  const std::size_t at = said.find("vernier import tracker POINTS"),
                    end = said.find("; if an instrument", at);
  ASSERT_NE(at, std::string::npos) << said;
  std::string tracker = said.substr(at, end - at);
  tracker.replace(tracker.find("POINTS"), 6, "list.txt --column 1=x[mm] --column 2=y[mm] --column 3=z[mm]");
  const std::string table = remedy();
  ASSERT_EQ(run(tracker), 0) << said;
  ASSERT_EQ(run(table), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("Name,turret[deg],elbow[deg],x[mm],y[mm],z[mm]\n"));
  // The joints have their names and units: only the point is open.
  text::write_file(folder + "/log.csv", log_and_list("Name;turret [deg];elbow [deg];X;Y;Z", 1).log);
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(remedy(),
              HasSubstr("own.xml --column \"x[mm]=X\" --column \"y[mm]=Y\" --column \"z[mm]=Z\" -o"));
  ASSERT_EQ(run(remedy()), 0) << said;
  // A point with its units is named as computed too.
  text::write_file(folder + "/log.csv",
                   log_and_list("Name;turret [deg];elbow [deg];X [mm];Y [mm];Z [mm]", 1).log);
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said, HasSubstr("the control probably computed it from the joints, and it is no measurement"));
  EXPECT_THAT(remedy(), HasSubstr("--column \"x=X [mm]\" --column \"y=Y [mm]\" --column \"z=Z [mm]\" -o"));
  ASSERT_EQ(run(remedy()), 0) << said;
  // A point that differs from the nominal machine can be measured.
  std::string measured = log_and_list("Name;turret [deg];elbow [deg];X;Y;Z", 1).log;
  for (std::size_t row = 0, place = 0; (place = measured.find(";0.000\n", place)) != std::string::npos; ++row)
    measured.replace(place, 6, fmt::format(";{:.3f}", 0.4 * std::sin(5.0 * static_cast<double>(row))));
  text::write_file(folder + "/log.csv", measured);
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said, testing::Not(HasSubstr("the control probably computed it")));
  // Joints alone are a list of positions.
  text::write_file(folder + "/log.csv", "Name;A1;A2\nP1;10;20\nP2;30;45\nP3;11;9\n");
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said, HasSubstr("the table has the positions of the axes and no reading"));
  EXPECT_THAT(remedy(), HasSubstr("vernier import tracker POINTS --nominal log.csv"));
}

TEST_F(ImportRemedies, OfAPartOfThePointsIsTheWholePoint) {
  text::write_file(folder + "/own.xml", own_names());
  const auto [log, list] = log_and_list("Name;turret [deg];elbow [deg];X;Y;Z", 1);
  text::write_file(folder + "/log.csv", log);
  text::write_file(folder + "/list.txt", list);
  const std::string call = "vernier import tracker list.txt --nominal log.csv --machine own.xml -o read.csv";
  ASSERT_EQ(run(call + " --column 3=x[mm]"), 1) << said;
  EXPECT_THAT(said,
              HasSubstr("list.txt: \"y, z\": the list has columns of numbers that are not read (column 1, "
                        "2), and no column is y, z"));
  EXPECT_FALSE(fs::exists(folder + "/read.csv"));
  const std::size_t first = said.find("vernier import"), end = said.find("; if the instrument", first);
  ASSERT_NE(end, std::string::npos) << said;
  const std::string whole = said.substr(first, end - first), part = remedy();
  ASSERT_EQ(run(whole), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("turret[deg],elbow[deg],x[mm],y[mm],z[mm]\n"));
  ASSERT_EQ(run(part), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::StartsWith("turret[deg],elbow[deg],x[mm],unused_1"));
  // Columns with the names that a page gives them have no meaning either.
  EXPECT_EQ(run(call + " --column 3=z[mm] --column 1=column_1 --column 2=column_2"), 1) << said;
  // Nothing is forgotten beside the positions of an axis.
  text::write_file(folder + "/z.txt", "0 1.5 20.1 7.5\n100 2.5 20.2 7.7\n200 3.5 20.3 7.1\n");
  EXPECT_EQ(run("vernier import tracker z.txt --column 1=X[mm] --column 2=x[mm] -o z.csv"), 0) << said;
}

TEST_F(ImportRemedies, BesideAnAxisWithANameOfItsOwnAreAccepted) {
  text::write_file(folder + "/slide.xml",
                   R"xml(<machine name="s"><variables><static><k value="0" nominal="0"/></static>
  <machineaxes><slide rotary="false" min="0" max="600"/></machineaxes></variables>
  <transforms><sixdof n="1" X="slide" Y="k*slide"/></transforms></machine>)xml");
  const std::string call = "vernier import table t.csv --machine slide.xml -o read.csv";
  text::write_file(folder + "/t.csv", "slide [mm];foo\n0;0,1\n100;100,2\n200;200,4\n300;300,1\n");
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said,
              testing::AllOf(HasSubstr("--column \"x[mm]=foo\""), testing::Not(HasSubstr("--deviation"))));
  ASSERT_EQ(run(call + " --column 'x[mm]=foo'"), 0) << said;
  // Deviations: no option reads them, and none is proposed.
  text::write_file(folder + "/t.csv", "slide [mm];foo [mm]\n0;0,1\n100;0,2\n200;0,4\n300;0,1\n");
  ASSERT_EQ(run(call), 1) << said;
  EXPECT_THAT(said, HasSubstr("a new column SUM of the table: the position of slide plus \"foo [mm]\""));
  EXPECT_THAT(said, testing::Not(HasSubstr("=foo")));
}

/// The columns become those of the axes by the machine file: no user has stated their unit.
TEST_F(ImportRemedies, JointsInAnotherUnitThanTheirHeadingAreRefusedBesideTheMachineToo) {
  text::write_file(folder + "/arm.xml", kArm);
  text::write_file(folder + "/deg.csv", poses_of_arm("rad", 1));
  ASSERT_EQ(run("vernier import table deg.csv --machine arm.xml -o read.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("degrees under a heading in rad"));
  EXPECT_THAT(said, HasSubstr("if [rad] is right, give --column \"J1[rad]=A1 [rad]\""));
  text::write_file(folder + "/right.csv", poses_of_arm("deg", 1));
  ASSERT_EQ(run("vernier import table right.csv --machine arm.xml -o read.csv"), 0) << said;
}

TEST_F(ImportRemedies, ARepeatedPoseThatContradictsIsNamedByImportLintAndFit) {
  text::write_file(folder + "/arm.xml", kArm);
  const std::string csv = poses_of_arm("deg", 1);
  std::string wrong = csv.substr(csv.find('\n') + 1, csv.find('\n', csv.find('\n') + 1) - csv.find('\n'));
  wrong.replace(wrong.rfind(','), std::string::npos, ",3.7\n");
  text::write_file(folder + "/log.csv", csv + wrong);
  const std::string words =
      "The rows in lines 2 and 22 of read.csv have the same commanded position, and their points are 3700 um "
      "apart";
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml -o read.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("note: " + words));
  ASSERT_EQ(run("vernier lint arm.xml read.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("read.csv:22: warning: " + words));
  ASSERT_EQ(run("vernier fit arm.xml read.csv -o fitted.xml"), 0) << said;
  EXPECT_THAT(said, HasSubstr(words));
  EXPECT_THAT(text::read_file(folder + "/fitted.xml"), HasSubstr("contradicting-rows"));
  text::write_file(folder + "/log.csv", csv);
  ASSERT_EQ(run("vernier import table log.csv --machine arm.xml -o read.csv"), 0) << said;
  EXPECT_THAT(said, testing::Not(HasSubstr("the same commanded position")));
}

TEST_F(ImportRemedies, TheDirectionsOfPointsFollowFromTheOrderOfTheirList) {
  text::write_file(folder + "/points.txt", "P1 0 0 0\nP2 100 0 0\nP3 50 20 0\n");
  text::write_file(folder + "/list.csv", "point,X[mm],Y[mm]\nP1,0,0\nP2,100,0\nP3,50,20\n");
  const std::string note =
      "note: the rows have no directions of the motion (dirX, dirY), and a fit needs them";
  ASSERT_EQ(
      run("vernier import tracker points.txt --nominal list.csv --machine m.xml --column 1=point --column "
          "'2=x[mm]' --column '3=y[mm]' --column '4=z[mm]' -o read.csv"),
      0)
      << said;
  EXPECT_THAT(said, HasSubstr(note));
  ASSERT_EQ(
      run("vernier import tracker points.txt --nominal list.csv --machine m.xml --column 1=point --column "
          "'2=x[mm]' --column '3=y[mm]' --column '4=z[mm]' --directions from-order -o read.csv"),
      0)
      << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::AllOf(HasSubstr("dirX,dirY\n"), HasSubstr("P2,100,0,0,1,0\n"),
                             HasSubstr("P3,50,20,0,-1,1\n")));
  EXPECT_THAT(said, testing::Not(HasSubstr(note)));
}

// The lines of the tracker have another order than the measurement, and P2 is lost.
TEST_F(ImportRemedies, TheDirectionsOfPointsInAnotherOrderAreThoseOfTheList) {
  text::write_file(folder + "/list.csv", "point,X[mm],Y[mm]\nP1,0,0\nP2,100,0\nP3,50,20\nP4,120,10\n");
  const std::string call =
      "vernier import tracker points.txt --machine m.xml --column 1=point --column '2=x[mm]' --column "
      "'3=y[mm]' --column '4=z[mm]' --directions from-order -o read.csv";
  text::write_file(folder + "/points.txt", "P4 120 10 0\nP3 50 20 0\nP1 0 0 0\n");
  ASSERT_EQ(run(call + " --nominal list.csv"), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::AllOf(HasSubstr("P4,120,10,0,1,-1\n"), HasSubstr("P3,50,20,0,-1,1\n"),
                             HasSubstr("P1,0,0,0,0,0\n")));
  EXPECT_THAT(said,
              HasSubstr("note: the approach directions (dirX, dirY) follow from the order of the positions "
                        "in list.csv"));
  // Runs divide the list: the first position of a run has no direction.
  text::write_file(folder + "/points.txt", "P4 120 10 0 b\nP3 50 20 0 b\nP1 0 0 0 a\n");
  ASSERT_EQ(run(call + " --nominal list.csv --column 5=run"), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/read.csv"),
              testing::AllOf(HasSubstr("P4,120,10,0,b,1,-1\n"), HasSubstr("P3,50,20,0,b,0,0\n")));
}

// The numbers of the points, in no order, are their names and no coordinate; a stated u changes nothing in
// the call.
TEST_F(ImportRemedies, NumbersOfPointsInAnyOrderAreTheirNames) {
  text::write_file(folder + "/points.txt",
                   "Messung Halle 2\n3 50.01 20.2 0.1\n1 0.2 0.11 0.3\n4 120.3 10.2 0.4\n2 100.4 0.5 0.2\n");
  text::write_file(folder + "/list.csv", "Punkt;X[mm];Y[mm]\n1;0;0\n2;100;0\n3;50;20\n4;120;10\n");
  ASSERT_EQ(
      run("vernier import tracker points.txt --nominal list.csv --machine m.xml --set 'u[um]=2' -o read.csv"),
      1)
      << said;
  EXPECT_THAT(said,
              testing::AllOf(HasSubstr("--column 1=point --column \"2=x[mm]\" --column \"3=y[mm]\" --column "
                                       "\"4=z[mm]\""),
                             HasSubstr("--set \"u[um]=2\"")));
  const std::string call = said.substr(said.rfind("give: ") + std::string("give: ").size());
  ASSERT_EQ(run(call.substr(0, call.find('\n'))), 0) << said;
  EXPECT_THAT(said, HasSubstr("joined by the names in point"));
  EXPECT_THAT(text::read_file(folder + "/read.csv"), HasSubstr("50,20,3,50.01,20.2,0.1,2\n"));
}

TEST_F(ImportRemedies, OfATrackerReadTheFileThatIsThere) {
  text::write_file(folder + "/pts.txt", "// SA\nP1, 0.01, 400, 0\nP2, 100, 400.01, 0\nP3, 200, 400, 0.01\n");
  const std::string call =
      "vernier import tracker pts.txt --comment // --column 2=x[mm] --column 3=y[mm] --column 4=z[mm] "
      "--machine m.xml ";
  ASSERT_EQ(run(call + "-o c.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("give --nominal FILE"));
  EXPECT_THAT(said, HasSubstr("vernier import tracker pts.txt --column \"2=x[mm]\""));
  text::write_file(folder + "/nom.csv", "Punkt;X [mm];Y [mm]\nP3;200;400\nP2;100;400\nP1;0;400\n");
  ASSERT_EQ(run(call + "--column 1=point --nominal nom.csv -o c.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("3 points and the positions of nom.csv, joined by the names in point"));
  EXPECT_THAT(text::read_file(folder + "/c.csv"),
              testing::StartsWith("X[mm],Y[mm],x[mm],y[mm],z[mm],point\n0,400,0.01,400,0,P1\n"));
}

}  // namespace
}  // namespace vernier::import_remedies_test
