// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/kinds.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tools/text/files.h"

namespace vernier::import_kinds_test {

using namespace vernier::importer;
namespace {

TEST(ImportKinds, EachIsOnThePageOfImports) {
  const std::string page = text::read_file(VERNIER_SOURCE_DIR "/tools/docs/import.md");
  for (const ImportKind& kind : import_kinds())
    EXPECT_NE(page.find(std::string("vernier import ") + kind.name + " "), std::string::npos) << kind.name;
}

TEST(ImportKinds, EndingsAreOfOneKindAndInSmallLetters) {
  std::set<std::string> endings, names;
  for (const ImportKind& kind : import_kinds()) {
    const std::string ending = kind.ending;
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    if (ending.empty()) continue;
    EXPECT_TRUE(endings.insert(ending).second) << ending;
    ASSERT_NE(import_kind_of("day 1" + ending), nullptr) << ending;
    EXPECT_STREQ(import_kind_of("day 1" + ending)->name, kind.name);
  }
  EXPECT_STREQ(import_kind_of("A/B.RTL")->name, "laser");
  for (const char* other : {"", "rtl", "a.csv", "a.rtl.csv", ".json"})
    EXPECT_EQ(import_kind_of(other), nullptr) << other;
}

}  // namespace
}  // namespace vernier::import_kinds_test
