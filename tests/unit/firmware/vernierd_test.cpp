// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon itself, in real time, as a user calls it. Times are reported by it and not judged here.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/unit/firmware/small_machine.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::vernierd_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

struct Outcome {
  int status;
  std::string out;
};

Outcome run(const std::string& arguments) {
  const std::string command = std::string(VERNIER_BIN_DIR) + "/vernierd " + arguments + " 2>/dev/null";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out};
}

class Vernierd : public testing::Test {
 protected:
  Vernierd() {
    std::filesystem::create_directories(directory_);
    const std::string text = kSmallMachine;
    const auto image = compile_machine(parse_machine(text, "small.xml"), text, {}).image;
    write_file(directory_ + "/machine.vimg", {image.begin(), image.end()});
  }
  ~Vernierd() override { std::filesystem::remove_all(directory_); }
  const std::string directory_ = testing::TempDir() + "vernierd_" + std::to_string(getpid()) + "_" +
                                 testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Vernierd, RunsInRealTimeAndReportsEveryTick) {
  const Outcome outcome = run("--image " + directory_ + " --simulate --seconds 1.5 --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.out;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["ticks"], 1500);
  EXPECT_EQ(json["equation"], "executed") << "the firmware of the tests has no machine built in";
  EXPECT_EQ(json["mode"], "active");
  EXPECT_EQ(json["fault"], "none");
  EXPECT_EQ(json["latency_us"]["count"], 1500);
  EXPECT_GT(json["active_ticks"], 500);
  EXPECT_LE(json["latency_us"]["p50"], json["latency_us"]["p99"]);
  EXPECT_GT(json["execution_us"]["p50"], 0);
}

TEST_F(Vernierd, RefusesWithoutABackendAndWithABrokenImage) {
  EXPECT_EQ(run("--image " + directory_).status, 1);
  EXPECT_EQ(run("").status, 1);
  EXPECT_EQ(run("--image " + directory_ + "/nowhere --simulate").status, 1);
  EXPECT_EQ(run("--image " + directory_ + " --simulate --seconds x").status, 1);
  std::string bytes = read_file(directory_ + "/machine.vimg");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_file(directory_ + "/machine.vimg", bytes);
  EXPECT_EQ(run("--image " + directory_ + " --simulate --seconds 1").status, 1);
  EXPECT_EQ(run("--help").status, 0);
}

}  // namespace
}  // namespace vernier::vernierd_test
