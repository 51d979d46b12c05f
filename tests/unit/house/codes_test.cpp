// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace vernier::house {
namespace {

// Enumerators of a namespace without a number: their code would follow their place in the source.
std::vector<std::string> without_number(std::string text) {
  text = std::regex_replace(text, std::regex("//[^\n]*"), "");
  std::vector<std::string> found;
  const std::regex list("(?:^|\\n)enum (?:class )?(\\w+)[^;{]*\\{([^}]*)\\}");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), list); it != std::sregex_iterator(); ++it) {
    std::istringstream entries((*it)[2].str());
    for (std::string entry; std::getline(entries, entry, ',');)
      if (entry.find_first_not_of(" \n") != std::string::npos && entry.find('=') == std::string::npos)
        found.push_back((*it)[1].str() + ":" + entry);
  }
  return found;
}

TEST(CodesOfTheHouse, MissingNumberIsDetected) {
  EXPECT_EQ(without_number("enum class A : int { kOne = 1, kTwo };").size(), 1u);
  EXPECT_EQ(without_number("enum B {\n  kOne,  // = 1\n  kTwo = 2,\n};").size(), 1u);
  EXPECT_TRUE(without_number("enum class A : int {\n  kOne = 1,  // a, b\n  kTwo = 2,\n};").empty());
}

// All of tables is stored or sent; these of comp stand in images or touches.
TEST(CodesOfTheHouse, WhatTravelsHasItsNumber) {
  namespace fs = std::filesystem;
  const fs::path root = VERNIER_SOURCE_DIR;
  std::vector<fs::path> files = {"comp/compensator.h", "comp/equation.h", "comp/verify.h",
                                 "comp/probing/latch.h", "comp/probing/touch_filter.h"};
  for (const auto& entry : fs::directory_iterator(root / "tables"))
    if (entry.path().extension() == ".h") files.push_back(entry.path().lexically_relative(root));
  std::size_t enums = 0;
  for (const fs::path& file : files) {
    std::ostringstream text;
    text << std::ifstream(root / file).rdbuf();
    for (const std::string& code : without_number(text.str())) ADD_FAILURE() << file << ": " << code;
    for (std::size_t at = 0; (at = text.str().find("enum ", at)) != std::string::npos; ++at) ++enums;
  }
  EXPECT_GE(enums, 14u);
}

}  // namespace
}  // namespace vernier::house
