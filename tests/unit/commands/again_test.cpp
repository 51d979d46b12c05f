// SPDX-License-Identifier: GPL-3.0-or-later
// Reports, machine files and results are made again from their own record, byte for byte.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/text/files.h"

namespace vernier::again_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

constexpr const char* kMachine =
    R"(<machine name="slide"><variables><static><s value="0" unit="1"/><c value="0" unit="mm"/></static>
  <machineaxes><X rotary="false" min="0" max="400" maxcorrection="0.5" maxslew="5"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X*(1+s)+c" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>
)";

struct Again : testing::Test {
  Again() {
    fs::create_directories(folder + "/data");
    write_file(folder + "/data/machine.xml", kMachine);
    std::string rows = "X[mm],x[mm],u[um],run\n";
    for (int run = 1; run <= 3; ++run)
      for (int i = 0; i <= 20; ++i) {
        const double x = 20.0 * i, noise_um = ((i * 7 + run * 5) % 11) - 5;
        rows += std::to_string(x) + "," + std::to_string(x * 1.00005 + 0.001 * 0.2 * noise_um) + ",1,r" +
                std::to_string(run) + "\n";
      }
    write_file(folder + "/data/survey.csv", rows);
  }
  ~Again() override { fs::remove_all(folder); }
  int run(const std::string& words) const { return run_in(folder, words); }
  static int run_in(const std::string& place, const std::string& words) {
    const int status = std::system(
        ("cd '" + place + "' && PATH=" VERNIER_BIN_DIR ":$PATH sh -ec \"" + words + "\" >said.txt 2>&1")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(folder + "/said.txt"); }
  const std::string folder = testing::TempDir() + "again_" + std::to_string(getpid());
};

TEST_F(Again, EveryKindOfFileIsMadeAgainToTheByte) {
  ASSERT_EQ(run("mkdir out;"
                "vernier fit data/machine.xml data/survey.csv -o fitted.xml --json out/fit.json;"
                "vernier compare fitted.xml data/survey.csv -o out/report.html --header 'serial number=4711'"
                " --json out/compare.json;"
                "vernier diagnose data/machine.xml data/survey.csv -o out/why.html --json out/why.json;"
                "vernier compile fitted.xml -o image"),
            0)
      << said();
  for (const char* file : {"fitted.xml", "out/fit.json", "out/report.html", "out/compare.json",
                           "out/why.html", "out/why.json", "image/bound.json", "image"})
    EXPECT_EQ(run(std::string("vernier again ") + file), 0) << file << " " << said();
  // From another folder, and with an absolute path.
  fs::create_directories(folder + "/elsewhere");
  EXPECT_EQ(run_in(folder + "/elsewhere", "vernier again ../out/report.html"), 0);
  EXPECT_EQ(run_in(folder + "/elsewhere", "vernier again '" + folder + "/fitted.xml'"), 0);
}

TEST_F(Again, AFolderThatMovedIsStillMadeAgain) {
  ASSERT_EQ(run("mkdir out; vernier compare data/machine.xml data/survey.csv -o out/report.html"), 0)
      << said();
  const std::string moved = folder + "_moved";
  fs::rename(folder, moved);
  EXPECT_EQ(run_in(moved, "vernier again out/report.html"), 0);
  fs::rename(moved, folder);
}

TEST_F(Again, AbsoluteNamesStayInsideTheTemporaryFolder) {
  const std::string in = folder + "/data/", out = folder + "/report.html";
  ASSERT_EQ(run("vernier compare " + in + "machine.xml " + in + "survey.csv -o " + out), 0) << said();
  const auto before = fs::last_write_time(out);
  EXPECT_EQ(run("vernier again report.html"), 0) << said();
  EXPECT_EQ(fs::last_write_time(out), before);
}

TEST_F(Again, ChangedMissingAndEditedFilesAreReported) {
  ASSERT_EQ(run("vernier fit data/machine.xml data/survey.csv -o fitted.xml --json fit.json"), 0) << said();
  const std::string survey = read_file(folder + "/data/survey.csv");

  std::string edited = read_file(folder + "/fit.json");
  edited.replace(edited.find("\"rms"), 4, "\"rmz");
  write_file(folder + "/edited.json", edited);
  EXPECT_EQ(run("vernier again edited.json"), 2) << said();

  write_file(folder + "/data/survey.csv", survey + "410,410.02,1,r3\n");
  EXPECT_EQ(run("vernier again fitted.xml --json again.json"), 2) << said();
  EXPECT_NE(said().find("changed since: data/survey.csv"), std::string::npos) << said();
  const auto json = nlohmann::json::parse(read_file(folder + "/again.json"));
  EXPECT_FALSE(json.at("same").get<bool>());
  EXPECT_EQ(json.at("changed_inputs").at(0), "data/survey.csv");
  EXPECT_GT(json.at("first_difference").at("byte").get<int>(), 1);

  fs::remove(folder + "/data/survey.csv");
  EXPECT_EQ(run("vernier again fitted.xml"), 1);
  EXPECT_NE(said().find("data/survey.csv"), std::string::npos) << said();
  EXPECT_EQ(run("vernier again data/machine.xml"), 1);
  EXPECT_NE(said().find("has no record of how it was made"), std::string::npos) << said();
  EXPECT_EQ(run("vernier again said.txt"), 1);
  EXPECT_EQ(run("vernier again nothing.html"), 1);
}

// A record can come from anybody.
TEST_F(Again, ARecordRunsNoOtherCommandAndLeavesNoFile) {
  const auto page = [&](const std::string& program, const std::string& command) {
    write_file(folder + "/page.html", "<!doctype html>\n<!-- made by: {\"program\":\"" + program +
                                          "\",\"command\":" + command +
                                          ",\"folder\":\".\",\"inputs\":[]} -->\n");
  };
  for (const char* command :
       {R"(["board","activate","\u002d\u002dto","tcp://127.0.0.1:1"])", R"(["keys","k"])",
        R"(["workbench","."])", R"(["again","page.html"])", R"(["upload","x"])", "[]"}) {
    page("vernier 0.1.0", command);
    EXPECT_EQ(run("vernier again page.html"), 1) << command;
    EXPECT_NE(said().find("not run"), std::string::npos) << said();
  }
  page("vernier 0.1.0",
       R"(["new","gantry","\u002do","../../../../../../../../../../../../../../tmp/out.xml"])");
  EXPECT_EQ(run("vernier again page.html"), 1);
  EXPECT_NE(said().find("leads out of the temporary folder"), std::string::npos) << said();
  page("x--><h1>ACCEPTED</h1><!--", R"(["compare","m.xml"])");
  EXPECT_EQ(run("vernier again page.html"), 1);
  EXPECT_NE(said().find("version of this program"), std::string::npos) << said();
}

TEST_F(Again, OfAFolderEveryFileIsCompared) {
  ASSERT_EQ(run("vernier fit data/machine.xml data/survey.csv -o f.xml; vernier compile f.xml -o image"), 0)
      << said();
  EXPECT_EQ(run("vernier again image"), 0) << said();
  write_file(folder + "/image/equation.cpp", read_file(folder + "/image/equation.cpp") + "//\n");
  EXPECT_EQ(run("vernier again image"), 2) << said();
  EXPECT_NE(said().find("equation.cpp"), std::string::npos) << said();
}

TEST_F(Again, TheRecordHasTheHashesOfTheInputs) {
  ASSERT_EQ(run("vernier fit data/machine.xml data/survey.csv -o fitted.xml --json fit.json"), 0) << said();
  const auto made = nlohmann::json::parse(read_file(folder + "/fit.json")).at("made_by");
  EXPECT_EQ(made.at("folder"), ".");
  for (const auto& input : made.at("inputs")) {
    ASSERT_EQ(run("sha256sum " + input.at("name").get<std::string>()), 0) << said();
    EXPECT_EQ(said().substr(0, 64), input.at("sha256"));
  }
  ASSERT_EQ(made.at("inputs").size(), 2U);
  // A file that is written again has one record only, and its image is of this file.
  ASSERT_EQ(run("vernier fit fitted.xml data/survey.csv -o twice.xml; vernier compile twice.xml -o image"), 0)
      << said();
  const std::string twice = read_file(folder + "/twice.xml");
  EXPECT_EQ(twice.find("made by: "), twice.rfind("made by: "));
  EXPECT_EQ(read_file(folder + "/image/machine.xml"), twice);
}

}  // namespace
}  // namespace vernier::again_test
