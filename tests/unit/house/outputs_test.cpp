// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace vernier::house {
namespace {

// Ways to make or replace a file beside write_output (hal/support/output_file.h), which alone knows what to
// do about links, devices and pipes.
std::vector<std::string> other_ways_to_write(const std::string& text) {
  std::vector<std::string> found;
  for (const char* way : {"ofstream", "fopen(", "O_CREAT", "::rename("})
    if (text.find(way) != std::string::npos) found.emplace_back(way);
  return found;
}

TEST(OutputsOfTheHouse, OtherWaysToWriteAreDetected) {
  EXPECT_EQ(other_ways_to_write("std::ofstream(path) << text;").size(), 1u);
  EXPECT_EQ(other_ways_to_write("std::fopen(path, \"w\"); std::rename(a, b);").size(), 2u);
  EXPECT_EQ(other_ways_to_write("::open(path, O_WRONLY | O_CREAT)").size(), 1u);
  EXPECT_TRUE(other_ways_to_write("std::ifstream(path); write_output(path, text); rename(column);").empty());
}

TEST(OutputsOfTheHouse, AreWrittenByOneFunction) {
  namespace fs = std::filesystem;
  // A secret key is made where nothing stands, and never over anything; a lock holds nothing, and what stands
  // in its place is opened and left as it is.
  const std::map<std::string, std::vector<std::string>> allowed = {
      {"tools/commands/run/keys.cpp", {"O_CREAT"}}, {"tools/fleet/spool.cpp", {"O_CREAT"}}};
  const fs::path root = VERNIER_SOURCE_DIR;
  std::size_t files = 0;
  for (const char* folder : {"firmware", "tools"}) {
    for (auto it = fs::recursive_directory_iterator(root / folder); it != fs::recursive_directory_iterator();
         ++it) {
      if (it->path().filename() == "node_modules") it.disable_recursion_pending();
      const auto extension = it->path().extension();
      if (!it->is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
      std::ostringstream text;
      text << std::ifstream(it->path()).rdbuf();
      ++files;
      const std::string path = it->path().lexically_relative(root).string();
      const auto excused = allowed.find(path);
      EXPECT_EQ(other_ways_to_write(text.str()),
                excused == allowed.end() ? std::vector<std::string>() : excused->second)
          << path;
    }
  }
  EXPECT_GT(files, 100u) << "the walk over the sources found next to nothing";
}

}  // namespace
}  // namespace vernier::house
