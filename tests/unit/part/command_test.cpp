// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier part` as a user calls it: artefacts, keys, exit statuses, nothing written on error.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/unit/part/part_data.h"
#include "tools/model/machine_reader.h"
#include "tools/simulate/path.h"

namespace vernier::command_test {

using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::format;
using namespace vernier::text;
namespace {

class PartCommand : public testing::Test {
 protected:
  PartCommand() { std::filesystem::create_directories(directory_); }
  ~PartCommand() override { std::filesystem::remove_all(directory_); }

  int part(const std::string& arguments) const {
    const int status = std::system((std::string(VERNIER_BIN_DIR) + "/vernier part " + arguments + " --json " +
                                    directory_ + "/out.json >/dev/null 2>&1")
                                       .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  nlohmann::json json() const { return nlohmann::json::parse(read_file(directory_ + "/out.json")); }
  std::string out() const { return directory_ + "/out"; }
  std::string directory_ = testing::TempDir() + "part_" + std::to_string(getpid()) + "_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(PartCommand, WritesPathDefectMachineAndReport) {
  ASSERT_EQ(part("s-shape --errors EA0B=3.2419e-4rad,EX0B=0.0294mm -o " + out()), 0);
  const auto result = json();
  EXPECT_NEAR(result["defect"]["tip_along_flank"][0]["min_mm"], -0.191688, 2e-6);
  EXPECT_NEAR(result["defect"]["tip_along_flank"][1]["max_mm"], 0.191907, 2e-6);
  EXPECT_EQ(result["observability"][1]["rank"], 6);
  EXPECT_EQ(result["observability"][1]["unidentifiable"].size(), 2u);
  EXPECT_NEAR(result["curves"][0]["per_span_mm"], 51.4077, 5.1e-5);
  const Machine written = read_machine(out() + "/machine.xml");
  EXPECT_NEAR(written.statics[written.find_static("EX0B").value()].value, 0.0294, 1e-12);
  EXPECT_NE(read_file(out() + "/report.html").find("S-shaped test part"), std::string::npos);
  EXPECT_EQ(parse_csv(read_file(out() + "/defect.csv"), "defect.csv").rows.size(), 100u);
}

TEST_F(PartCommand, PathsAreFitForSimulateAndAgreeWithTheGCode) {
  ASSERT_EQ(part("s-shape --feed 600 --step 2 -o " + out()), 0);
  for (const char flank : {'A', 'B'}) {
    const Path path(read_file(out() + "/path_" + flank + ".csv"), "path.csv");
    for (const char* name : {"X", "Y", "Z"})
      EXPECT_EQ(path.numbers(name, Dimension::kLength).size(), path.time().size());
    const Column c = path.numbers("C", Dimension::kAngle);
    // 637 mm at 10 mm/s, less the chords.
    EXPECT_NEAR(path.time()[path.time().size() - 1], 63.73, 0.05);
    const std::string gcode = read_file(out() + "/path_" + flank + ".nc");
    std::size_t moves = 0, at = 0;
    while ((at = gcode.find("\nG1 ", at + 1)) != std::string::npos) ++moves;
    EXPECT_EQ(moves + 1, path.rows());
    EXPECT_NE(gcode.find("\nG93\n"), std::string::npos);
    EXPECT_LT(c.abs().maxCoeff(), 95);
  }
}

TEST_F(PartCommand, IdentifiesFromItsOwnPredictionWithAnotherMachineFile) {
  const std::string machine = std::string(VERNIER_SOURCE_DIR) + "/tables/machines/five_axis_bhead_ctable.xml";
  ASSERT_EQ(part("s-shape --errors EA0B=0.02,EC0Y=-0.01 --machine " + machine + " -o " + out()), 0);
  ASSERT_EQ(part("s-shape --identify " + out() + "/defect.csv --machine " + machine + " -o " + directory_ +
                 "/found"),
            0);
  const auto result = json();
  EXPECT_GT(result["rms_before_um"], 50);
  EXPECT_LT(result["rms_um"], 1e-3);
  for (const auto& parameter : result["parameters"]) {
    const double wanted = parameter["name"] == "EA0B" ? 0.02 : parameter["name"] == "EC0Y" ? -0.01 : 0;
    EXPECT_NEAR(parameter["value"], wanted, 1e-6)
        << parameter;  // points with six, defects with nine decimals
  }
  const Machine written = read_machine(directory_ + "/found/machine.xml");
  EXPECT_NEAR(written.statics[written.find_static("EA0B").value()].value, 0.02, 1e-6);
}

TEST_F(PartCommand, FreesOnlyWhatItIsToldTo) {
  ASSERT_EQ(part("s-shape --errors EA0B=0.02,EX0B=0.03 -o " + out()), 0);
  ASSERT_EQ(part("s-shape --identify " + out() + "/defect.csv --free EX0B,EA0B -o " + directory_ + "/found"),
            0);
  EXPECT_EQ(json()["parameters"].size(), 2u);
  const Machine written = read_machine(directory_ + "/found/machine.xml");
  EXPECT_FALSE(written.statics[written.find_static("EC0Y").value()].hidden);  // the file's own freedom stays
}

TEST_F(PartCommand, GaugeBlock) {
  ASSERT_EQ(part("gauge-block " + part_data::path("gauge_block.csv") + " --pivot-length 533.889"), 0);
  EXPECT_NEAR(json()["EA0B_rad"], -3.549e-4, 5.1e-8);
  EXPECT_NEAR(json()["EX0B_mm"], 0.003, 1e-9);
  const std::string bad = directory_ + "/bad.csv";
  for (const char* text : {"C[deg],y[mm]\n0,1\n90,1\n180,1\n", "C[deg],y[mm]\n0,1\n0,1\n90,1\n180,1\n270,1\n",
                           "C[deg],y[mm]\n0,1\n45,1\n", "C[deg],y\n0,1\n", "C[deg],y[mm]\n0,x\n"}) {
    write_file(bad, text);
    EXPECT_EQ(part("gauge-block " + bad + " --pivot-length 500"), 1) << text;
  }
  EXPECT_EQ(part("gauge-block " + part_data::path("gauge_block.csv") + " --pivot-length 0"), 1);
}

TEST_F(PartCommand, ToleranceIsJudgedWithTheUncertaintyOfTheMeasuringMachine) {
  // GIVEN a part that errors of table 4 leave 0.19 mm off at most: a zone of 0.12 mm is not met, one of 0.4
  // mm is, and one of 0.39 mm is undecided for a machine that measures with U = 0.01 mm
  const std::string errors = " --errors EA0B=3.2419e-4rad,EX0B=0.0294mm";
  EXPECT_EQ(part("s-shape -o " + out() + errors + " --tolerance 0.12 --uncertainty 0.01"), 2);
  EXPECT_EQ(json()["tolerance"]["conformity"], "not met");
  ASSERT_EQ(part("s-shape -o " + out() + errors + " --tolerance 0.5 --uncertainty 0.01"), 0);
  EXPECT_EQ(json()["tolerance"]["conformity"], "met");
  const double farthest = std::abs(json()["tolerance"]["farthest_mm"].get<double>());
  const std::string close = " --tolerance " + std::to_string(2 * farthest + 0.01);
  ASSERT_EQ(part("s-shape -o " + out() + errors + close + " --uncertainty 0.01"), 0);
  EXPECT_EQ(json()["tolerance"]["conformity"], "not decided (within the uncertainty)");
  ASSERT_EQ(part("s-shape -o " + out() + errors + close + " --uncertainty 0.004"), 0);
  EXPECT_EQ(json()["tolerance"]["conformity"], "met");
  // The same points as a measured part.
  ASSERT_EQ(
      part("s-shape -o " + out() + "2 --identify " + out() + "/defect.csv" + close + " --uncertainty 0.004"),
      0);
  EXPECT_EQ(json()["tolerance"]["of"], "measured");
  EXPECT_NEAR(std::abs(json()["tolerance"]["farthest_mm"].get<double>()), farthest, 1e-6);
}

TEST_F(PartCommand, BadInputIsStatusOneAndWritesNothing) {
  const auto refused = [&](const std::string& arguments) {
    EXPECT_EQ(part("s-shape -o " + out() + " " + arguments), 1) << arguments;
    EXPECT_FALSE(std::filesystem::exists(out())) << arguments;
    EXPECT_FALSE(std::filesystem::exists(directory_ + "/out.json")) << arguments;
  };
  refused("--errors EA0X=1");
  refused("--tool-diameter 0");
  refused("--tool-diameter 120");  // thicker than the hollows
  refused("--tool-length 20");     // shorter than the flank
  refused("--feed -5");
  refused("--reading sideways");
  refused("--free NOPE");
  refused("--identify /nonexistent.csv");
  refused("--machine " + std::string(VERNIER_SOURCE_DIR) + "/tables/machines/gantry.xml");
  refused("--aligned");
  EXPECT_EQ(part(""), 1);
  EXPECT_EQ(part("s-shape"), 1);
}

}  // namespace
}  // namespace vernier::command_test
