// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/house/units.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> sources_of_the_house() {
  std::map<std::string, std::string> files;
  for (const std::string& path : tracked_files()) {
    const std::string extension = fs::path(path).extension().string();
    if ((extension == ".h" || extension == ".cpp") && !path.starts_with("tests/"))
      files[path] = text_of(path);
  }
  return files;
}

TEST(Units, ACircleIsDetected) {
  // GIVEN a source that includes what includes its header
  const std::map<std::string, std::string> files = {
      {"tools/fit/a.h", "#pragma once\n"},
      {"tools/fit/a.cpp", "#include \"tools/fit/a.h\"\n#include \"tools/fit/b.h\"\n"},
      {"tools/fit/b.h", "#include \"tools/fit/noise/c.h\"\n"},
      {"tools/fit/noise/c.h", "#include \"tools/fit/a.h\"\n"},
      {"tools/fit/d.cpp", "#include \"tools/fit/a.h\"\n#include \"tools/model/a.h\"\n"}};
  EXPECT_EQ(circles_of_units(files), std::vector<std::string>{"tools/fit/a tools/fit/b tools/fit/noise/c"});
}

TEST(Units, ACircleOfFoldersIsDetected) {
  // GIVEN two folders that include each other through different units
  const std::map<std::string, std::string> files = {{"tools/fit/a.cpp", "#include \"tools/fit/noise/c.h\"\n"},
                                                    {"tools/fit/noise/d.h", "#include \"tools/fit/b.h\"\n"}};
  EXPECT_TRUE(circles_of_units(files).empty());
  EXPECT_EQ(circles_of_folders(files), std::vector<std::string>{"tools/fit tools/fit/noise"});
}

TEST(Units, OfOtherRoomsAreNoCircle) {
  EXPECT_TRUE(circles_of_units({{"tools/fit/a.cpp", "#include \"tools/fit/a.h\"\n#include \"comp/b.h\"\n"},
                                {"comp/b.h", "#include \"tools/fit/a.h\"\n"}})
                  .empty());
}

TEST(Units, AreCountedByFolder) {
  const std::map<std::string, std::string> files = {
      {"hal/a.h", ""}, {"hal/a.cpp", ""}, {"hal/b.h", ""}, {"hal/linux/c.h", ""}};
  EXPECT_EQ(units_in_folders(files), (std::map<std::string, std::size_t>{{"hal", 2}, {"hal/linux", 1}}));
}

TEST(Units, NoneOfTheHouseStandInACircle) {
  const std::map<std::string, std::string> files = sources_of_the_house();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  EXPECT_GT(files.size(), 500u) << "next to no source was found";
  EXPECT_EQ(circles_of_units(files), std::vector<std::string>{});
  EXPECT_EQ(circles_of_folders(files), std::vector<std::string>{});
}

TEST(Units, NoFolderOfTheHouseHoldsMoreThanFifteen) {
  constexpr std::size_t kMost = 15;  // the architecture's limit: a folder with more is two folders
  for (const auto& [folder, count] : units_in_folders(sources_of_the_house()))
    EXPECT_LE(count, kMost) << folder;
}

}  // namespace
}  // namespace vernier::house
