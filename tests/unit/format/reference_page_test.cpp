// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/reference_page.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tools/format/columns.h"
#include "tools/format/readings.h"
#include "tools/text/files.h"

namespace vernier::format {
namespace {

TEST(ReferencePage, IsWhatTheTablesPrint) {
  const std::string path = std::string(VERNIER_SOURCE_DIR) + "/tools/docs/measurement_columns.md";
  if (std::getenv("VERNIER_UPDATE_GOLDEN") != nullptr) text::write_file(path, reference_page());
  EXPECT_EQ(text::read_file(path), reference_page())
      << "VERNIER_UPDATE_GOLDEN=1 in the environment writes tools/docs/measurement_columns.md";
}

TEST(ReferencePage, NamesEveryColumnKindAndUnit) {
  const std::string page = reference_page();
  const auto has = [&](const std::string& words) { return page.find(words) != std::string::npos; };
  for (const ColumnGroup& group : column_groups())
    for (const char* const name : group.list()) EXPECT_TRUE(has("`" + heading(name) + "`")) << name;
  for (const ReadingKindEntry& kind : kReadingKinds)
    EXPECT_TRUE(has("\n| `" + std::string(kind.name) + "` |")) << kind.name;
  for (const Dimension dimension : all_dimensions())
    for (const std::string& unit : units_of(dimension)) EXPECT_TRUE(has("`" + unit + "`")) << unit;
}

}  // namespace
}  // namespace vernier::format
