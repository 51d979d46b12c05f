// SPDX-License-Identifier: GPL-3.0-or-later
// One version: CMake's, which the programs print and the change log has.
#include <gtest/gtest.h>

#include <cstdio>
#include <regex>
#include <string>

#include "tools/text/files.h"

namespace vernier::version_test {

using namespace vernier::text;
namespace {

std::string output_of(const std::string& command) {
  std::FILE* const pipe = popen((std::string(VERNIER_BIN_DIR) + "/" + command).c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
  EXPECT_EQ(pclose(pipe), 0) << command;
  return out;
}

TEST(Version, ProgramsPrintThatOfTheProject) {
  for (const std::string program : {"vernier", "vernierd"}) {
    const std::string out = output_of(program + " --version");
    EXPECT_TRUE(
        std::regex_match(out, std::regex(program + " " VERNIER_VERSION " \\(([0-9a-f]{12}|unknown)\\)\n")))
        << out;
    EXPECT_EQ(output_of(program + " -V"), out);
  }
}

TEST(Version, NewestReleaseOfTheChangeLogIsThatOfTheProject) {
  const std::string text = read_file(std::string(VERNIER_SOURCE_DIR) + "/CHANGELOG.md");
  std::smatch release;
  ASSERT_TRUE(std::regex_search(text, release,
                                std::regex("\n## \\[(\\d+\\.\\d+\\.\\d+)\\] - \\d{4}-\\d\\d-\\d\\d\n")));
  EXPECT_EQ(release[1], VERNIER_VERSION);
}

}  // namespace
}  // namespace vernier::version_test
