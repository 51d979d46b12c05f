// SPDX-License-Identifier: GPL-3.0-or-later
// What the programs do to what stands where their outputs go: each writer, as a user calls it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tools/text/files.h"

namespace vernier::outputs_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

constexpr const char* kMachine = R"xml(<machine name="m"><variables>
  <static><k value="0.0001" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

/// A command that leaves one output where OUT stands, and what that holds.
struct Writer {
  const char* name;
  const char* command;
  const char* holds;
};

void PrintTo(const Writer& writer, std::ostream* out) { *out << writer.name; }

const Writer kWriters[] = {
    {"Machine", "vernier set m.xml k=0.5 -o OUT", "<machine"},
    {"ResultForPrograms", "vernier set m.xml k=0.5 -o x.xml --json OUT", "\"k\": 0.5"},
    {"Report", "vernier compare m.xml rows.csv -o OUT", "<html"},
    {"ResultOfTheDaemon",
     "vernier compile m.xml -o image && vernierd --image image --simulate --seconds 0.2 --no-realtime --json "
     "OUT",
     "\"ticks\": 200"},
};

/// A folder with a machine and rows, where commands are run.
class OutputFolder : public testing::Test {
 protected:
  OutputFolder() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ + "/far");
    write_file(in("m.xml"), kMachine);
    write_file(in("rows.csv"), "X[mm],x[mm],run\n0,0.001,a\n100,100.012,a\n300,300.031,b\n500,500.052,b\n");
  }
  ~OutputFolder() override { fs::remove_all(folder_); }

  std::string in(const std::string& name) const { return folder_ + "/" + name; }
  /// Exit status of a shell's line.
  int run(const std::string& line) const {
    const std::string command =
        "cd '" + folder_ + "' && PATH=" VERNIER_BIN_DIR ":$PATH && { " + line + "; } >out.txt 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(in("out.txt")); }

  const std::string folder_ = [] {
    std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(test.begin(), test.end(), '/', '_');
    return testing::TempDir() + "outputs_" + std::to_string(getpid()) + "_" + test;
  }();
};

class Outputs : public OutputFolder, public testing::WithParamInterface<Writer> {
 protected:
  int write_to(const std::string& name, const std::string& before = "", const std::string& after = "") const {
    std::string command = GetParam().command;
    command.replace(command.find("OUT"), 3, name);
    return run(before + command + after);
  }
  void expect_output_in(const std::string& name) const {
    EXPECT_NE(read_file(in(name)).find(GetParam().holds), std::string::npos) << said();
  }
};

TEST_P(Outputs, PipeIsWrittenTo) {
  ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
  // Were the pipe replaced, its reader would wait for ever.
  EXPECT_EQ(write_to("pipe", "timeout 60 cat pipe >got & ", "; status=$?; wait $!; exit $status"), 0);
  struct stat status {};
  ASSERT_EQ(::stat(in("pipe").c_str(), &status), 0);
  EXPECT_TRUE(S_ISFIFO(status.st_mode));
  expect_output_in("got");
}

TEST_P(Outputs, LinkStays) {
  write_file(in("far/real"), "old");
  fs::create_symlink("far/real", in("link"));
  EXPECT_EQ(write_to("link"), 0);
  EXPECT_TRUE(fs::is_symlink(in("link")));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(in("far/real"))));
  expect_output_in("far/real");
}

TEST_P(Outputs, LinkThatLeadsNowhereYetGetsItsTarget) {
  fs::create_symlink("far/new", in("link"));
  EXPECT_EQ(write_to("link"), 0);
  EXPECT_TRUE(fs::is_symlink(in("link")));
  expect_output_in("far/new");
}

TEST_P(Outputs, StandardOutputByItsNameGoesOnWhereItWas) {
  // A link of our own, as /dev/stdout is one: were it replaced, this machine would keep its own.
  if (!fs::exists("/proc/self/fd/1")) GTEST_SKIP() << "no /proc on this machine";
  fs::create_symlink("/proc/self/fd/1", in("stdout"));
  EXPECT_EQ(write_to("stdout", "{ echo before; ", "; echo after; } >got"), 0);
  expect_output_in("got");
  const std::string got = read_file(in("got"));
  EXPECT_EQ(got.substr(0, 7), "before\n");
  EXPECT_EQ(got.substr(got.size() - 6), "after\n");
  EXPECT_TRUE(fs::is_symlink(in("stdout")));
}

TEST_P(Outputs, FullDeviceIsAnErrorAndStays) {
  // A link of our own: were it replaced, no device of this machine would suffer.
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  fs::create_symlink("/dev/full", in("link"));
  EXPECT_EQ(write_to("link"), 1);
  EXPECT_TRUE(fs::is_symlink(in("link")));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_NE(said().find("No space left on device"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Every, Outputs, testing::ValuesIn(kWriters),
                         [](const auto& writer) { return std::string(writer.param.name); });

TEST_F(OutputFolder, MayBeALinkAndHoldLinks) {
  fs::create_symlink("far/image", in("link"));
  EXPECT_EQ(run("vernier compile m.xml -o link"), 0);
  EXPECT_TRUE(fs::is_symlink(in("link")));
  EXPECT_TRUE(fs::is_regular_file(in("far/image/machine.vimg")));
  fs::rename(in("far/image/machine.vimg"), in("far/real"));
  fs::create_symlink("../real", in("far/image/machine.vimg"));
  const std::string before = read_file(in("far/real"));
  write_file(in("far/real"), "old");
  EXPECT_EQ(run("vernier compile m.xml -o link"), 0);
  EXPECT_TRUE(fs::is_symlink(in("far/image/machine.vimg")));
  EXPECT_EQ(read_file(in("far/real")), before);
}

TEST_F(OutputFolder, FileInItsPlaceIsAnError) {
  write_file(in("file"), "old");
  for (const char* command :
       {"vernier compile m.xml -o file", "vernier keys -o file",
        "vernier improve m.xml rows.csv -o file --yes", "vernier part s-shape -o file"}) {
    EXPECT_EQ(run(command), 1) << command << "\n" << said();
    EXPECT_NE(said().find("vernier: file: "), std::string::npos) << said();
  }
  EXPECT_EQ(read_file(in("file")), "old");
}

/// A template of `new` with the column on was refused by fit without a remedy.
TEST_F(OutputFolder, NewMachineForTouchesHasAnArtefactAndItsAbsenceIsNamed) {
  EXPECT_EQ(run("vernier new gantry --axis X:0:600 --axis Y:0:600 --axis Z:0:300 -o bed.xml --measurements "
                "bed.csv --reading on"),
            0)
      << said();
  EXPECT_NE(read_file(in("bed.xml")).find("<artefact name=\"bed\" type=\"plane\"/>"), std::string::npos);
  write_file(in("touched.csv"), "X[mm],on,u[um]\n0,bed,1\n10,bed,1\n");
  EXPECT_EQ(run("vernier compare m.xml touched.csv"), 1);
  EXPECT_NE(
      said().find("the machine file has no <artefact>; state what the tool point touched, such as <artefact "
                  "name=\"bed\" type=\"plane\"/>"),
      std::string::npos)
      << said();
  EXPECT_EQ(run("vernier new gantry --axis X:0:600 --axis Y:0:600 --axis Z:0:300 -o plain.xml"), 0) << said();
  EXPECT_EQ(read_file(in("plain.xml")).find("<artefact"), std::string::npos);
}

/// The component applies what screw tables cannot express, so that a machine with squareness has files too.
TEST_F(OutputFolder, LinuxCncHasTheComponentWhereScrewTablesCannotExpressTheMachine) {
  write_file(in("square.xml"), R"xml(<machine name="m"><variables>
  <static><k value="0.0001" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/>
  <Y rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*Y" Y="Y"/></transforms></machine>)xml");
  EXPECT_EQ(run("vernier export linuxcnc square.xml -o out"), 0) << said();
  EXPECT_NE(said().find("note: no screw-compensation file: a screw-compensation file cannot express"),
            std::string::npos)
      << said();
  EXPECT_NE(said().find("depends on the position of Y: up to "), std::string::npos) << said();
  EXPECT_TRUE(fs::exists(in("out/vernier.hal")) && fs::exists(in("out/image/machine.vimg")));
  EXPECT_FALSE(fs::exists(in("out/X.comp")));
  EXPECT_EQ(run("vernier export linuxcnc square.xml -o out2 --leave-out"), 0) << said();
  EXPECT_TRUE(fs::exists(in("out2/X.comp")) && fs::exists(in("out2/vernier.hal")));
  EXPECT_EQ(run("vernier export linuxcnc square.xml -o x.comp --axis X"), 1) << said();
  EXPECT_FALSE(fs::exists(in("x.comp")));
}

/// "13 um before, 3.6 with the files" was read as the error of the machine, which nobody had measured.
TEST_F(OutputFolder, ExportSaysThatItsFiguresAreThoseOfTheModel) {
  write_file(in("mill.xml"),
             R"xml(<machine name="m"><variables><static><k value="0.0001" nominal="0"/></static>
  <machineaxes><X min="0" max="600" maxcorrection="0.2" maxslew="5"/>
  <Y min="0" max="400" maxcorrection="0.2" maxslew="5"/>
  <Z min="-300" max="0" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*X"/><sixdof n="2" Y="Y"/><sixdof n="3" Z="Z"/></transforms></machine>)xml");
  write_file(in("arm.xml"), R"xml(<machine name="arm"><variables><static>
  <off value="0.01" nominal="0" unit="deg"/></static>
  <machineaxes><A rotary="true" min="-90" max="90"/></machineaxes></variables>
  <transforms><sixdof n="1" rZ="A+off"/><sixdof n="2" X="300"/></transforms></machine>)xml");
  for (const char* command :
       {"siemens mill.xml -o out_siemens", "klipper mill.xml -o out_klipper --steps 40,40,8",
        "linuxcnc mill.xml -o out_linuxcnc --component", "linuxcnc mill.xml -o out_screws --axis X",
        "urdf arm.xml -o out_urdf"}) {
    ASSERT_EQ(run(std::string("vernier export ") + command + " --json result.json"), 0) << command << said();
    const std::string words = "The machine was not measured with these files";
    EXPECT_NE(said().find(words), std::string::npos) << command << said();
    EXPECT_NE(read_file(in("result.json")).find(words), std::string::npos) << command;
    EXPECT_EQ(said().find("um before"), std::string::npos) << command << said();
  }
  ASSERT_EQ(run("vernier export siemens mill.xml -o again"), 0) << said();
  EXPECT_NE(said().find("the model predicts an error of the tool point of "), std::string::npos) << said();
  EXPECT_NE(said().find("um rms; that is not the accuracy of the machine"), std::string::npos) << said();
}

/// A linear test of one axis, out and back in three runs, in the order of its readings.
std::string laser_rows(int axis) {
  const std::string letters = "XYZ", small = "xyz";
  std::string rows = std::string("X[mm],Y[mm],Z[mm],dir") + letters[static_cast<std::size_t>(axis)] +
                     ",run," + small[static_cast<std::size_t>(axis)] + "[mm],u[um],role\n";
  int count = 0;
  for (int run = 1; run <= 3; ++run)
    for (const int sense : {1, -1})
      for (int k = 0; k <= 10; ++k) {
        const int at = 30 * (sense < 0 ? 10 - k : k);
        std::array<int, 3> position = {150, 150, 150};
        position[static_cast<std::size_t>(axis)] = at;
        const double noise = 0.0004 * ((count * 7 + axis) % 5 - 2);
        const double error = 0.008 * std::sin(at / 60.0 + axis) + 0.004 * sense / (axis + 1) + noise;
        rows += std::to_string(position[0]) + "," + std::to_string(position[1]) + "," +
                std::to_string(position[2]) + "," + std::to_string(sense) + "," + std::to_string(run) + "," +
                std::to_string(at + error) + ",0.6," + (++count % 5 == 0 ? "check" : "fit") + "\n";
      }
  return rows;
}

/// A user with a laser alone had no export: the columns that a laser along an axis cannot see were as
/// uncertain as before the fit, and the remedy of the refusal held everything.
TEST_F(OutputFolder, LaserAloneHasAMachineAndTheCommandsToItsExport) {
  for (int axis = 0; axis < 3; ++axis) write_file(in(std::string(1, "xyz"[axis]) + ".csv"), laser_rows(axis));
  ASSERT_EQ(
      run("vernier new column --axis X:0:300 --axis Y:0:300 --axis Z:0:300 --stations X=30 --stations Y=30 "
          "--stations Z=30 -o mill.xml"),
      0)
      << said();
  ASSERT_EQ(run("vernier improve mill.xml x.csv y.csv z.csv -o out --yes"), 0) << said();
  const std::string improved = said();
  EXPECT_NE(improved.find("verdict: missing-effect"), std::string::npos) << improved;
  ASSERT_NE(
      improved.find("fit the machine again without the parameters that no reading determines: fit --hold \""),
      std::string::npos)
      << improved;
  const auto begin = improved.find("fit --hold \"") + 12;
  const std::string held = improved.substr(begin, improved.find('"', begin) - begin);
  EXPECT_EQ(held.find("table.X.X"), std::string::npos) << held;
  EXPECT_NE(held.find("table.X.Y,"), std::string::npos) << held;
  ASSERT_EQ(run("vernier fit \"$(ls out/*_backlash.xml | tail -1)\" x.csv y.csv z.csv --hold \"" + held +
                "\" -o held.xml && vernier export siemens held.xml -o files"),
            0)
      << said();
}

using Instruments = OutputFolder;

/// x y z of a tracker whose frame is turned by 35 degrees about z and moved, 0.1 um; k = 0.0001 in X.
std::string turned_rows() {
  std::string rows = "X[mm],x[mm],y[mm],u[mm]\n";
  constexpr double kCos = 0.8191520443, kSin = 0.5735764364;
  for (int x = 0; x <= 600; x += 50) {
    const double true_x = 1.0001 * x;
    rows += std::to_string(x) + "," + std::to_string(1200 + kCos * true_x) + "," +
            std::to_string(kSin * true_x - 340) + ",0.001\n";
  }
  return rows;
}

TEST_F(Instruments, LaserAndTurnedTrackerAreFittedTogether) {
  std::string machine = kMachine;
  machine.replace(machine.find("<k value=\"0.0001\""), 17, "<BaseShift/><k value=\"0\"");
  write_file(in("m.xml"), machine);
  write_file(in("laser.csv"), "X[mm],x[mm],u[mm]\n0,0,0.001\n300,300.03,0.001\n600,600.06,0.001\n");
  write_file(in("tracker.csv"), turned_rows());
  ASSERT_EQ(run("vernier fit m.xml laser.csv tracker.csv -o f.xml"), 0) << said();
  EXPECT_NE(said().find("tracker.csv has its own set-up BaseShift[tracker]"), std::string::npos) << said();
  EXPECT_NE(read_file(in("f.xml")).find("<BaseShift setup=\"tracker\""), std::string::npos);
  // Before the fit the tracker is somewhere: its distance is no error of the machine.
  ASSERT_EQ(run("vernier fit m.xml tracker.csv -o t.xml --json t.json"), 0) << said();
  EXPECT_NE(said().find(" um   with only the set-up fitted\n"), std::string::npos) << said();
  const std::string json = read_file(in("t.json"));
  const std::string key = "\"rms_only_set_up_um\": ";
  ASSERT_NE(json.find(key), std::string::npos) << json;
  // 0.1 um/mm over 600 mm is 60 um: a rigid motion takes its mean, and an rms of 18 um remains.
  EXPECT_LT(std::stod(json.substr(json.find(key) + key.size())), 30);
  EXPECT_NE(json.find("\"rms_before_um\": "), std::string::npos) << json;
  // The fitted machine knows the set-up of the file by its name.
  ASSERT_EQ(run("vernier compare f.xml tracker.csv --limit 1um"), 0) << said();
  ASSERT_EQ(run("vernier compare f.xml laser.csv --limit 1um"), 0) << said();
}

TEST_F(Instruments, AFileWithoutUBesideAFileWithUHasItsOwnNoise) {
  std::string machine = kMachine;
  machine.replace(machine.find("<k value=\"0.0001\""), 17, "<BaseShift/><k value=\"0\"");
  write_file(in("m.xml"), machine);
  std::string laser = "X[mm],x[mm],u[um]\n", coarse = "X[mm],x[mm]\n", few = coarse;
  for (int i = 0; i <= 20; ++i) {
    const double x = 30.0 * i, read = 1.0001 * x;
    laser += std::to_string(x) + "," + std::to_string(read) + ",0.5\n";
    // A residual of 20 um, without a period of the machine.
    coarse += std::to_string(x) + "," + std::to_string(read + 5 + 0.02 * (i % 3 - 1)) + "\n";
    if (i < 4) few += std::to_string(x) + "," + std::to_string(read + 5) + "\n";
  }
  write_file(in("laser.csv"), laser);
  write_file(in("coarse.csv"), coarse);
  write_file(in("few.csv"), few);
  const std::string level =
      "coarse.csv: the lengths of this file have no u, and other readings have one. The "
      "estimate u = 1";  // 20 um * sqrt(2 / 3) is 16.3 um
  ASSERT_EQ(run("vernier fit m.xml laser.csv coarse.csv -o f.xml"), 0) << said();
  EXPECT_NE(said().find(level), std::string::npos) << said();
  ASSERT_EQ(run("vernier diagnose m.xml laser.csv coarse.csv"), 0) << said();
  EXPECT_NE(said().find(level), std::string::npos) << said();
  ASSERT_EQ(run("vernier improve m.xml laser.csv coarse.csv -o better --yes"), 0) << said();
  EXPECT_NE(said().find(level), std::string::npos) << said();
  ASSERT_EQ(run("vernier compare f.xml laser.csv coarse.csv"), 0) << said();
  EXPECT_NE(said().find("coarse.csv: the lengths of this file have no u"), std::string::npos) << said();
  ASSERT_EQ(run("vernier check f.xml coarse.csv"), 0) << said();
  EXPECT_NE(said().find("note: coarse.csv has no u: the standard uncertainty of its readings is taken as"),
            std::string::npos)
      << said();
  EXPECT_EQ(run("vernier fit m.xml laser.csv few.csv -o f.xml"), 1) << said();
  EXPECT_NE(said().find("State the standard uncertainty: a column u[um]"), std::string::npos) << said();
}

TEST_F(Instruments, ReadingsOfTwoKindsWithoutAnyUAreSaidToHaveOneWeight) {
  const auto survey = [](const std::string& heading, const std::string& u) {
    std::string rows = heading;
    for (int i = 0; i <= 20; ++i)
      rows += fmt::format("{},{:.6f}{}\n", 30 * i, 30 * i * 1.0001 + 0.001 * (i % 3 - 1), u);
    return rows;
  };
  const auto lengths = [](const std::string& heading, const std::string& u) {
    return fmt::format(
        "point,X[mm],distance[mm],from{0}\nA,0,,{1}\nB,300,300.05,A{1}\nC,600,600.04,A{1}\nD,450,450.06,A{1}"
        "\n",
        heading, u);
  };
  const std::string words = "have no standard uncertainty (u)",
                    note = "the readings of laser.csv, caliper.csv " + words;
  write_file(in("laser.csv"), survey("X[mm],x[mm]\n", ""));
  write_file(in("caliper.csv"), lengths("", ""));
  ASSERT_EQ(run("vernier fit m.xml laser.csv caliper.csv -o f.xml --json f.json"), 0) << said();
  EXPECT_NE(said().find("note: " + note), std::string::npos) << said();
  EXPECT_NE(read_file(in("f.json")).find(note), std::string::npos);
  // One kind alone, and two kinds with u.
  ASSERT_EQ(run("vernier fit m.xml laser.csv -o f.xml"), 0) << said();
  EXPECT_EQ(said().find(words), std::string::npos) << said();
  write_file(in("laser.csv"), survey("X[mm],x[mm],u[um]\n", ",1"));
  write_file(in("caliper.csv"), lengths(",u[mm]", ",0.02"));
  ASSERT_EQ(run("vernier fit m.xml laser.csv caliper.csv -o f.xml"), 0) << said();
  EXPECT_EQ(said().find(words), std::string::npos) << said();
}

TEST_F(Instruments, ATableGetsStationsWithTheValuesThatItHasThere) {
  write_file(in("m.xml"), R"xml(<machine name="m"><variables><machineaxes><X min="0" max="600"/></machineaxes>
<comptables><table axis="X" fit="X Y" scale="0.02 0.001"><station loc="0" X="0"/><station loc="300" X="0.003"/>
<station loc="600" X="0.001" Y="0.0004"/></table></comptables></variables>
<transforms><sixdof X="X+lXx" Y="lXy"/></transforms></machine>)xml");
  std::string rows = "X[mm],x[mm],u[um]\n";
  for (int i = 0; i <= 20; ++i) rows += fmt::format("{},{:.4f},1\n", 30 * i, 30 * i + 0.001 * (i % 3));
  write_file(in("laser.csv"), rows);
  ASSERT_EQ(run("vernier fit m.xml laser.csv -o f.xml"), 0) << said();
  EXPECT_NE(read_file(in("f.xml")).find("<fitted"), std::string::npos);
  ASSERT_EQ(run("vernier set m.xml --stations X=150 -o s.xml"), 0) << said();
  EXPECT_NE(said().find("table of X: 5 stations, 3 before; fit the machine again"), std::string::npos)
      << said();
  const std::string text = read_file(in("s.xml"));
  EXPECT_NE(text.find("<station loc=\"150\" X=\"0.0015\""), std::string::npos) << text;
  EXPECT_NE(text.find("<station loc=\"450\" X=\"0.002\" Y=\"2e-04\" Z=\"0\""), std::string::npos) << text;
  EXPECT_NE(text.find("scale=\"0.02 0.001\""), std::string::npos) << text;
  // The record of a fit is about other parameters.
  ASSERT_EQ(run("vernier set f.xml --stations X=150 -o fs.xml"), 0) << said();
  EXPECT_EQ(read_file(in("fs.xml")).find("<fitted"), std::string::npos);
  ASSERT_EQ(run("vernier fit fs.xml laser.csv -o fsf.xml"), 0) << said();
  EXPECT_EQ(run("vernier set m.xml --stations Y=150 -o no.xml"), 1) << said();
  EXPECT_EQ(run("vernier set m.xml --stations X=0,900 -o no.xml"), 1) << said();
}

TEST_F(Instruments, ATravelCanBeReducedToWhatWasMeasured) {
  std::string machine = kMachine;
  machine.replace(machine.find("min=\"0\" max=\"600\""), 17, "min=\"-300\" max=\"600\"");
  write_file(in("m.xml"), machine);
  std::string rows = "X[mm],x[mm],u[um]\n";
  for (int i = 0; i <= 20; ++i)
    rows += fmt::format("{},{:.6f},1\n", 30 * i, 30 * i * 1.0001 + 0.001 * (i % 3 - 1));
  write_file(in("laser.csv"), rows);
  EXPECT_EQ(run("vernier set m.xml --measured-travel -o t.xml"), 1) << said();
  EXPECT_NE(said().find("no fit wrote this machine file"), std::string::npos) << said();
  ASSERT_EQ(run("vernier fit m.xml laser.csv -o f.xml"), 0) << said();
  ASSERT_EQ(run("vernier compile f.xml -o image"), 2) << said();
  EXPECT_NE(said().find("measured-range 0.5 of the measured range, limit 0.25: axis X, measured from 0 to "
                        "600, range -300 to 600"),
            std::string::npos)
      << said();
  EXPECT_NE(said().find("vernier set --measured-travel"), std::string::npos) << said();
  ASSERT_EQ(run("vernier set f.xml --measured-travel -o t.xml"), 0) << said();
  EXPECT_NE(said().find("X: travel from 0 to 600 mm, as measured"), std::string::npos) << said();
  const auto without_command = [](std::string text) {
    const std::size_t from = text.find("<!-- made by");
    return text.erase(from, text.find('\n', from) - from);
  };
  std::string expected = read_file(in("f.xml"));
  expected.replace(expected.find("min=\"-300\""), 10, "min=\"0\"");
  EXPECT_EQ(without_command(read_file(in("t.xml"))), without_command(expected));
  EXPECT_EQ(run("vernier compile t.xml -o image"), 0) << said();
  ASSERT_EQ(run("vernier set t.xml --measured-travel -o t2.xml"), 0) << said();
  EXPECT_NE(said().find("every axis was measured over its whole travel"), std::string::npos) << said();
}

}  // namespace
}  // namespace vernier::outputs_test
