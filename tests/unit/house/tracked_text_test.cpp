// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace vernier::house {
namespace {

// What the machine on which somebody worked is called has no place in a tracked file. The words are put
// together here so that this file does not contain them.
std::vector<std::string> words_of_a_workplace() {
  return {std::string("/wo") + "rk/", std::string("/home") + "/", std::string("registry.") + "npmjs",
          std::string("artifact") + "ory", std::string("/root") + "/"};
}

std::vector<std::string> tracked_files() {
  const std::string command = std::string("git -C '") + VERNIER_SOURCE_DIR + "' ls-files -z 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::vector<std::string> files;
  std::string name;
  for (int c = pipe ? std::fgetc(pipe.get()) : EOF; c != EOF; c = std::fgetc(pipe.get())) {
    if (c != '\0') {
      name.push_back(static_cast<char>(c));
      continue;
    }
    files.push_back(name);
    name.clear();
  }
  return files;
}

std::vector<std::string> found_words(const std::string& text) {
  std::vector<std::string> found;
  for (const auto& word : words_of_a_workplace()) {
    if (text.find(word) != std::string::npos) found.push_back(word);
  }
  return found;
}

TEST(TrackedText, WordOfAWorkplaceIsDetected) {
  for (const auto& word : words_of_a_workplace())
    EXPECT_EQ(found_words("a " + word + "b").size(), 1u) << word;
  EXPECT_TRUE(found_words("the workpiece is at home in the root branch").empty());
}

TEST(TrackedText, NamesNoWorkplace) {
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  for (const auto& file : files) {
    const auto path = std::filesystem::path(VERNIER_SOURCE_DIR) / file;
    if (!std::filesystem::is_regular_file(path)) continue;  // deleted in the working tree
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    for (const auto& word : found_words(text.str())) ADD_FAILURE() << file << " names \"" << word << '"';
  }
}

}  // namespace
}  // namespace vernier::house
