// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/path.h"

#include <gtest/gtest.h>

#include "tools/text/error.h"

namespace vernier::path_test {

using namespace vernier::simulate;
using namespace vernier::text;
namespace {

std::string message_of(const std::string& text) {
  try {
    Path(text, "path.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Path, NeedsATimeThatIncreases) {
  EXPECT_NE(message_of("X[mm]\n1\n").find("path.csv:1"), std::string::npos);
  const std::string repeated = message_of("t[s],X[mm]\n0,1\n0.5,2\n0.5,3\n");
  EXPECT_NE(repeated.find("path.csv:4"), std::string::npos) << repeated;
  EXPECT_NE(message_of("t[s],X[mm]\n1,1\n0,2\n").find("increase"), std::string::npos);
  EXPECT_NE(message_of("t[s],X[mm]\n,1\n").find("path.csv:2"), std::string::npos);
  EXPECT_NE(message_of("t[mm],X[mm]\n0,1\n").find("t[mm]"), std::string::npos);
  EXPECT_EQ(message_of("t[ms],X[mm]\n0,1\n5,3\n"), "accepted");
}

TEST(Ticks, CoverThePathFromTheFirstRowToTheLast) {
  const Path path("t[s]\n2\n2.0025\n2.3\n", "path.csv");
  const Ticks ticks = ticks_of(path, 1e-3);
  ASSERT_EQ(ticks.count(), 301u);
  EXPECT_EQ(ticks.time[0], 2);
  EXPECT_EQ(ticks.segment[2], 0u);
  EXPECT_NEAR(ticks.fraction[2], 0.8, 1e-9);
  EXPECT_EQ(ticks.segment[3], 1u);
  EXPECT_EQ(ticks.segment[300], 1u);
  EXPECT_NEAR(ticks.fraction[300], 1, 1e-9);
}

TEST(Ticks, TickOnARowBelongsToTheSegmentThatStartsThere) {
  std::string text = "t[s]\n";
  for (int i = 0; i <= 1000; ++i) text += std::to_string(i * 0.007) + "\n";
  const Path path(text, "path.csv");
  const Ticks ticks = ticks_of(path, 1e-3);
  ASSERT_EQ(ticks.count(), 7001u);
  for (std::size_t k = 0; k < 7000; ++k) ASSERT_EQ(ticks.segment[k], k / 7) << k;
}

TEST(Ticks, SingleRowIsOneTick) {
  const Ticks ticks = ticks_of(Path("t[s],X[mm]\n5,1\n", "path.csv"), 1e-3);
  ASSERT_EQ(ticks.count(), 1u);
  EXPECT_EQ(ticks.fraction[0], 0);
}

}  // namespace
}  // namespace vernier::path_test
