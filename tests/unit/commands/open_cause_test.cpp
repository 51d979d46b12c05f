// SPDX-License-Identifier: GPL-3.0-or-later
// The first effect of a survey has two possible causes: improve goes past it to what is certain with each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/text/files.h"

namespace vernier::open_cause_test {

using testing::ElementsAre;
using testing::HasSubstr;
namespace {

namespace fs = std::filesystem;

TEST(Improve, GoesPastAnOpenCauseToStepsThatAreCertainWithEachCause) {
  const std::string data = VERNIER_SOURCE_DIR "/tests/data/hidden/linear_test_open_lead",
                    folder = testing::TempDir() + "open_cause_" + std::to_string(getpid());
  fs::create_directories(folder);
  const int status = std::system(("cd '" + folder + "' && " VERNIER_BIN_DIR "/vernier improve " + data +
                                  "/model.xml " + data + "/survey.csv -o out --yes >said.txt 2>&1")
                                     .c_str());
  const std::string said = text::read_file(folder + "/said.txt");
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << said;
  const std::size_t open = said.find("verdict: ambiguous. 2 causes explain these data equally well");
  ASSERT_NE(open, std::string::npos) << said;
  EXPECT_THAT(said.substr(open), HasSubstr("the first effect has several possible causes"));

  // Creep explains the lead error and the reversal together nearly as well as both; the cyclic error stands
  // beside either. Once these are in the model, nothing else explains the lead error.
  const auto json = nlohmann::json::parse(text::read_file(folder + "/out/improve.json"));
  std::vector<std::string> effects;
  for (const auto& step : json["ladder"])
    if (!step["effect"].is_null()) effects.push_back(step["effect"]);
  EXPECT_THAT(effects, ElementsAre("backlash", "cyclic-error", "scale-error"));
  EXPECT_EQ(json["verdict"], "consistent");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace vernier::open_cause_test
