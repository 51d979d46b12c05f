// SPDX-License-Identifier: GPL-3.0-or-later
// Plans for accuracy and the conformity of parts as commands: what they print, write and end with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/text/files.h"

namespace vernier::conformity_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSurvey = VERNIER_SOURCE_DIR "/tests/data/hidden/bridge_lag_cyclic/";
const std::string kPlate = VERNIER_SOURCE_DIR "/tests/data/part/plate.csv";

class PartCommands : public testing::Test {
 protected:
  PartCommands() {
    fs::create_directories(folder_);
    // The model that the survey was made from, but for two effects: robust enough for a covariance.
    if (run("fit " + kSurvey + "model.xml " + kSurvey + "survey.csv -o fitted.xml") != 0)
      ADD_FAILURE() << said_;
  }
  ~PartCommands() override { fs::remove_all(folder_); }

  int run(const std::string& arguments) {
    const int status = std::system(("cd '" + folder_ + "' && timeout 300 " VERNIER_BIN_DIR "/vernier " +
                                    arguments + " >out.txt 2>err.txt")
                                       .c_str());
    said_ = read_file(folder_ + "/out.txt") + read_file(folder_ + "/err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  nlohmann::json result(const std::string& name) const {
    return nlohmann::json::parse(read_file(folder_ + "/" + name));
  }

  const std::string folder_ = testing::TempDir() + "part_commands_" + std::to_string(getpid());
  std::string said_;
};

TEST_F(PartCommands, ConformityOfAPlate) {
  ASSERT_EQ(run("part conformity fitted.xml " + kPlate + " --place 320,170,-300 --json r.json -o r.html"), 0)
      << said_;
  const nlohmann::json r = result("r.json");
  EXPECT_EQ(r["characteristics"].size(), 9u);
  EXPECT_GE(r["trials"], 20000);
  EXPECT_EQ(r["seed"], 1);
  EXPECT_TRUE(r["never_measured_known"]);
  for (const auto& one : r["characteristics"]) {
    for (const char* how : {"uncorrected", "corrected"}) {
      EXPECT_LE(one[how]["interval_um"][0], one[how]["interval_um"][1]);
      EXPECT_EQ(one[how]["probability"].is_null(), one["limits_um"].is_null());
    }
    // The model lacks two effects of two micrometres: the fit has seen that.
    EXPECT_GT(one["discrepancy"], 0.5);
    double sum = one["process"].get<double>() + one["discrepancy"].get<double>();
    for (const auto& source : one["sources"]) sum += source["share_of_variance"].get<double>();
    EXPECT_NEAR(sum, 1, 1e-6);
  }
  EXPECT_THAT(read_file(folder_ + "/r.html"), HasSubstr("bore A"));
  EXPECT_THAT(said_, HasSubstr("bore B: position, zone of 20 um"));
}

TEST_F(PartCommands, WhatDoesNotConformIsExitTwo) {
  write_file(folder_ + "/tight.csv",
             "feature,kind,x,y,z,diameter,position,datum\na,cylinder,100,100,-300,20,,yes\n"
             "b,cylinder,500,100,-300,20,,yes\nc,cylinder,300,350,-300,20,0.00001,\n");
  EXPECT_EQ(run("part conformity fitted.xml tight.csv"), 2);
  EXPECT_THAT(said_, HasSubstr("position of c"));
  write_file(folder_ + "/far.csv", "feature,kind,x,y,z\na,point,100,100,-250\nb,point,5000,0,-250\n");
  EXPECT_EQ(run("part conformity fitted.xml far.csv"), 2);
  EXPECT_THAT(said_, HasSubstr("far.csv:3"));
}

TEST_F(PartCommands, BadInputIsExitOneAndWritesNothing) {
  write_file(folder_ + "/bad.csv", "feature,kind,x,y,z\na,hole,1,2,3\n");
  EXPECT_EQ(run("part conformity fitted.xml bad.csv --json r.json -o r.html"), 1);
  EXPECT_THAT(said_, HasSubstr("bad.csv:2: \"hole\""));
  EXPECT_FALSE(fs::exists(folder_ + "/r.json"));
  EXPECT_FALSE(fs::exists(folder_ + "/r.html"));
  EXPECT_EQ(run("part conformity " + kSurvey + "model.xml " + kPlate), 1);
  EXPECT_THAT(said_, HasSubstr("never fitted"));
  EXPECT_EQ(run("part conformity fitted.xml " + kPlate + " --place 1,2"), 1);
  EXPECT_EQ(run("part conformity fitted.xml " + kPlate + " --zero X=1"), 1);
  EXPECT_EQ(run("plan fitted.xml --region Q=1:2 --accuracy 3"), 1);
  EXPECT_THAT(said_, HasSubstr("Q=1:2"));
  EXPECT_EQ(run("plan fitted.xml --region X=1:9000 --accuracy 3"), 1);
  EXPECT_EQ(run("plan " + kSurvey + "model.xml " + kSurvey + "survey.csv"), 1);
  EXPECT_THAT(said_, HasSubstr("--accuracy"));
}

TEST_F(PartCommands, MeasurementsStandInForAFit) {
  const std::string part = kPlate + " --place 320,170,-300 --json ";
  ASSERT_EQ(run("part conformity " + kSurvey + "model.xml " + part + "a.json " + kSurvey + "survey.csv"), 0)
      << said_;
  ASSERT_EQ(run("part conformity fitted.xml " + part + "b.json"), 0) << said_;
  // The file keeps seven digits of the covariance: the same trials to that.
  const double a = result("a.json")["characteristics"][2]["corrected"]["std_um"],
               b = result("b.json")["characteristics"][2]["corrected"]["std_um"];
  EXPECT_NEAR(a, b, 1e-3 * b);
}

TEST_F(PartCommands, PlanForAccuracyIsMeasuredByAFit) {
  const std::string plan = "plan " + kSurvey + "model.xml " + kSurvey + "survey.csv --accuracy ";
  ASSERT_EQ(run(plan + "4 -o next.csv --gcode next.nc --json r.json"), 0) << said_;
  const nlohmann::json r = result("r.json");
  EXPECT_LE(r["u95_um"], 4);
  EXPECT_GT(r["u95_now_um"], 4);
  EXPECT_GT(r["u95_random_um"], r["u95_um"]);
  EXPECT_EQ(r["rows"].size(), r["points"]);
  EXPECT_EQ(r["table"].back()["points"], r["points"]);
  const std::string rows = read_file(folder_ + "/next.csv");
  EXPECT_THAT(rows, HasSubstr("X[mm],dirX,Y[mm],dirY,Z[mm],dirZ,"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')),
            2 + r["points"].get<std::size_t>());
  EXPECT_THAT(read_file(folder_ + "/next.nc"), HasSubstr("; read"));
  EXPECT_EQ(run(plan + "0.01 --points 5 -o none.csv"), 2);
  EXPECT_THAT(said_, HasSubstr("limited by"));
  EXPECT_FALSE(fs::exists(folder_ + "/none.csv"));
  ASSERT_EQ(run(plan + "100 -o none.csv"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("no further measurement is needed"));
  EXPECT_FALSE(fs::exists(folder_ + "/none.csv"));
}

}  // namespace
}  // namespace vernier::conformity_test
