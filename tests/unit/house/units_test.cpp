// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/house/tracked_files.h"
#include "tests/unit/house/units.h"

namespace vernier::house {
namespace {

namespace fs = std::filesystem;

TEST(Units, ACircleIsDetected) {
  // GIVEN a source that includes what includes its header
  const std::map<std::string, std::string> files = {
      {"tools/fit/a.h", "#pragma once\n"},
      {"tools/fit/a.cpp", "#include \"tools/fit/a.h\"\n#include \"tools/fit/b.h\"\n"},
      {"tools/fit/b.h", "#include \"tools/fit/c.h\"\n"},
      {"tools/fit/c.h", "#include \"tools/fit/a.h\"\n"},
      {"tools/fit/d.cpp", "#include \"tools/fit/a.h\"\n#include \"tools/model/a.h\"\n"}};
  EXPECT_EQ(circles_of_units(files), std::vector<std::string>{"tools/fit: a b c"});
}

TEST(Units, OfOtherFoldersAreNoCircle) {
  EXPECT_TRUE(circles_of_units({{"tools/fit/a.cpp", "#include \"tools/fit/a.h\"\n#include \"comp/b.h\"\n"},
                                {"comp/b.h", "#include \"tools/fit/a.h\"\n"}})
                  .empty());
}

TEST(Units, NoneOfTheHouseStandInACircle) {
  const std::vector<std::string> tracked = tracked_files();
  if (tracked.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  std::map<std::string, std::string> files;
  for (const std::string& path : tracked) {
    const std::string extension = fs::path(path).extension().string();
    if ((extension != ".h" && extension != ".cpp") || path.starts_with("tests/")) continue;
    files[path] = text_of(path);
  }
  EXPECT_GT(files.size(), 500u) << "next to no source was found";
  EXPECT_EQ(circles_of_units(files), std::vector<std::string>{});
}

}  // namespace
}  // namespace vernier::house
