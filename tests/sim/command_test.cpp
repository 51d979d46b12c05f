// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier simulate` as a user calls it: keys, exit statuses, nothing written on error.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/format/csv_file.h"
#include "tools/text/files.h"

namespace vernier::command_test {

using namespace vernier::format;
using namespace vernier::text;
namespace {

constexpr const char* kMachine = R"xml(<machine name="m"><variables>
  <static><k value="0.0001" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

class SimulateCommand : public testing::Test {
 protected:
  SimulateCommand() {
    std::filesystem::create_directories(directory_);
    write_file(directory_ + "/truth.xml", kMachine);
    write_file(directory_ + "/path.csv", "t[s],X[mm]\n0,0\n2,500\n");
    EXPECT_EQ(vernier("compile " + directory_ + "/truth.xml -o " + directory_ + "/img"), 0);
  }
  ~SimulateCommand() override { std::filesystem::remove_all(directory_); }

  int vernier(const std::string& arguments) const {
    const int status =
        std::system((std::string(VERNIER_BIN_DIR) + "/vernier " + arguments + " >/dev/null 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int simulate(const std::string& more) const {
    return vernier("simulate --truth " + directory_ + "/truth.xml --image " + directory_ + "/img --path " +
                   directory_ + "/path.csv --json " + directory_ + "/out.json " + more);
  }
  std::string directory_ = testing::TempDir() + "simulate_" + std::to_string(getpid()) + "_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(SimulateCommand, WritesItsKeysAndEveryTick) {
  ASSERT_EQ(simulate("-o " + directory_ + "/ticks.csv"), 0);
  const auto json = nlohmann::json::parse(read_file(directory_ + "/out.json"));
  EXPECT_EQ(json["ticks"], 2001);
  EXPECT_EQ(json["saturated"], 0);
  EXPECT_EQ(json["overruns"], 0);
  // Scale of 1e-4 over 0..500 mm, aligned at the mean, spread over x, y, z: 50 um / sqrt(12) / sqrt(3).
  EXPECT_NEAR(json["rms_before_um"], 50 / std::sqrt(36.0), 0.02);
  EXPECT_LT(json["rms_after_um"], 0.005);
  EXPECT_LT(json["max_after_um"], 0.01);
  const CsvFile ticks = parse_csv(read_file(directory_ + "/ticks.csv"), "ticks.csv");
  EXPECT_EQ(ticks.rows.size(), 2001u);
}

TEST_F(SimulateCommand, SameInputSameNumbers) {
  const auto numbers = [&] {
    EXPECT_EQ(simulate("--dac 8 --noise-um 1 --seed 4"), 0);
    auto json = nlohmann::json::parse(read_file(directory_ + "/out.json"));
    json.erase("execution_ns");  // the host's, not the simulation's
    return json;
  };
  EXPECT_EQ(numbers(), numbers());
}

TEST_F(SimulateCommand, BadInputIsStatusOneAndWritesNothing) {
  EXPECT_EQ(simulate("--dac 12"), 1);
  write_file(directory_ + "/path.csv", "t[s],Y[mm]\n0,0\n2,500\n");
  EXPECT_EQ(simulate(""), 1);
  write_file(directory_ + "/path.csv", "t[s],X[mm]\n0,0\n2,5x0\n");
  EXPECT_EQ(simulate(""), 1);
  std::filesystem::remove(directory_ + "/img/machine.vimg");
  EXPECT_EQ(simulate(""), 1);
  EXPECT_FALSE(std::filesystem::exists(directory_ + "/out.json"));
}

}  // namespace
}  // namespace vernier::command_test
