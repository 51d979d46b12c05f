// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

// What the machine on which somebody worked is called has no place in a tracked file. The words are put
// together here so that this file does not contain them.
std::vector<std::string> words_of_a_workplace() {
  return {std::string("/wo") + "rk/", std::string("/home") + "/", std::string("registry.") + "npmjs",
          std::string("artifact") + "ory", std::string("/root") + "/"};
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
    for (const auto& word : found_words(text_of(file))) ADD_FAILURE() << file << " names \"" << word << '"';
  }
}

}  // namespace
}  // namespace vernier::house
