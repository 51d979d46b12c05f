// SPDX-License-Identifier: GPL-3.0-or-later
// Measured with the correction on, as a user goes about it: --images, compare --before --after.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/text/files.h"

namespace vernier::measured_on_command_test {

using namespace vernier::text;
namespace {

/// A scale error of 1e-4 on X and nothing else.
constexpr const char* kMachine = R"xml(<machine name="m"><variables>
  <static><k value="{}" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

class MeasuredOnCommand : public testing::Test {
 protected:
  MeasuredOnCommand() {
    std::filesystem::create_directories(directory_);
    write_file(file("true.xml"), fmt::format(kMachine, 1e-4));
    write_file(file("start.xml"), fmt::format(kMachine, 0));
    EXPECT_EQ(
        vernier("compile " + file("true.xml") + " -o " + file("june/image") + " --json " + file("c.json")),
        0);
    const auto image = nlohmann::json::parse(read_file(file("c.json")));
    fingerprint_ = image.value("fingerprint", "");
  }
  ~MeasuredOnCommand() override { std::filesystem::remove_all(directory_); }

  std::string file(const std::string& name) const { return directory_ + "/" + name; }
  int vernier(const std::string& arguments) const {
    const int status = std::system(
        (std::string(VERNIER_BIN_DIR) + "/vernier " + arguments + " >/dev/null 2>" + file("said")).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Readings of 1 um that alternate on an error of `left` * X.
  std::string survey(double left, const std::string& more, const std::string& cell) const {
    std::string text = "X[mm],x[mm]" + more + "\n";
    for (int i = 0; i <= 30; ++i)
      text += fmt::format("{},{}{}\n", 20 * i, 20 * i * (1 + left) + (i % 2 == 0 ? 1e-3 : -1e-3), cell);
    return text;
  }

  std::string fingerprint_, directory_ = testing::TempDir() + "measured_on_" + std::to_string(getpid()) +
                                         "_" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(MeasuredOnCommand, TheImageGivesTheMachineWithoutTheCorrection) {
  ASSERT_EQ(fingerprint_.size(), 16U);
  write_file(file("on.csv"), survey(0, ",corrected", "," + fingerprint_));
  const std::string fit = "fit " + file("start.xml") + " " + file("on.csv") + " --json " + file("fit.json");
  EXPECT_EQ(vernier(fit), 1);
  EXPECT_NE(read_file(file("said")).find("on.csv:2: \"" + fingerprint_ + "\""), std::string::npos);
  ASSERT_EQ(vernier(fit + " --images " + directory_), 0);
  const auto json = nlohmann::json::parse(read_file(file("fit.json")));
  // 31 readings of 1 um over 600 mm: 1e-6 is five of their uncertainties.
  EXPECT_NEAR(json["parameters"][0]["value"].get<double>(), 1e-4, 1e-6);
  for (const char* command : {"compare", "diagnose"})
    EXPECT_EQ(vernier(std::string(command) + " " + file("start.xml") + " " + file("on.csv") + " --images " +
                      directory_),
              0)
        << command;
}

TEST_F(MeasuredOnCommand, BeforeAndAfterAreComparedAndTold) {
  write_file(file("off.csv"), survey(1e-4, "", ""));
  write_file(file("on.csv"), survey(1e-5, ",correctionX[um]", ",0.5"));
  const std::string compare = "compare " + file("start.xml") + " --before " + file("off.csv");
  EXPECT_EQ(vernier(compare), 1);
  EXPECT_EQ(vernier(compare + " --after " + file("on.csv") + " " + file("off.csv")), 1);
  ASSERT_EQ(
      vernier(compare + " --after " + file("on.csv") + " --json " + file("j") + " -o " + file("r.html")), 0)
      << read_file(file("said"));
  const auto json = nlohmann::json::parse(read_file(file("j")));
  EXPECT_EQ(json["verdict"], "helped");
  EXPECT_EQ(json["paired"], true);
  // rms of 1e-4 * X over 0..600 in steps of 20: 34.9 um; with the noise of 1 um; a tenth of it after.
  EXPECT_NEAR(json["before_um"].get<double>(), 34.94, 0.1);
  EXPECT_NEAR(json["after_um"].get<double>(), 3.63, 0.1);
  EXPECT_NEAR(json["reduction"].get<double>(), 0.896, 0.01);
  EXPECT_LT(json["interval"][0].get<double>(), 0.896);
  EXPECT_GT(json["interval"][1].get<double>(), 0.89);
  EXPECT_EQ(json["groups"][0]["axis"], "x");
  EXPECT_NE(read_file(file("r.html")).find("Before and after"), std::string::npos);
}

}  // namespace
}  // namespace vernier::measured_on_command_test
