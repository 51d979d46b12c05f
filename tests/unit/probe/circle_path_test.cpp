// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/circle_path.h"

#include <gtest/gtest.h>

#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::circle_path_test {

using namespace vernier::probe;
using namespace vernier::text;
namespace {

std::string published(const char* name) {
  std::string text = read_file(std::string(VERNIER_SOURCE_DIR "/tests/data/ballbar/") + name);
  // One of the three ends with the mark of the end of a tape.
  if (const auto mark = text.find('%'); mark != std::string::npos) text.resize(mark);
  return text;
}

CirclePath xy(double feed_mm_min) {
  CirclePath path;
  path.feed_mm_min = feed_mm_min;
  return path;
}

CirclePath yz() {
  CirclePath path = xy(6000);
  path.plane = "YZ";
  path.from_deg = -5, path.to_deg = 185, path.overshoot_deg = 0;
  return path;
}

TEST(CirclePath, PublishedProgramsComeOutByteForByte) {
  EXPECT_EQ(circle_program(xy(5000), CircleDialect::kIso), published("ballbar_xy_100mm_f5000.nc"));
  EXPECT_EQ(circle_program(xy(6000), CircleDialect::kIso), published("ballbar_xy_100mm_f6000.nc"));
  EXPECT_EQ(circle_program(yz(), CircleDialect::kIso), published("ballbar_yz_100mm_f6000.nc"));
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(CirclePath, RobotRunsHalfTurnsThroughTheirMiddle) {
  const std::string text = circle_program(xy(5000), CircleDialect::kUrscript);
  // 720 deg in each sense, in half turns; the last of each sense ends without a blend.
  EXPECT_EQ(count_of(text, "movec("), 8u);
  EXPECT_EQ(count_of(text, "r=0, mode=1"), 2u);
  EXPECT_NE(text.find("vel = 0.083333"), std::string::npos);
  // From -A by -B to +A, counter-clockwise.
  EXPECT_NE(
      text.find("movec(p[0.0000000, -0.1000000, 0.0000000, 0.000000, 0.000000, 0.000000], p[0.1000000, "),
      std::string::npos)
      << text;
}

TEST(CirclePath, CentreShiftsPointsAndLeavesTheWordsOfTheCentre) {
  CirclePath path = yz();
  path.centre_mm = {10, 20, 30};
  const std::string text = circle_program(path, CircleDialect::kLinuxcnc);
  EXPECT_NE(text.find("G01 X10.000 Y121.114 Z21.154"), std::string::npos) << text;
  EXPECT_NE(text.find("G03 Y-79.619 Z21.284 J-99.619 K8.716"), std::string::npos) << text;
  EXPECT_EQ(text.find("G71"), std::string::npos);  // which would be a turning cycle there
}

TEST(CirclePath, WhatMakesNoSenseIsRefused) {
  const auto refused = [](auto change) {
    CirclePath path = xy(5000);
    change(path);
    EXPECT_THROW(circle_program(path, CircleDialect::kIso), InputError);
  };
  refused([](CirclePath& p) { p.radius_mm = 0; });
  refused([](CirclePath& p) { p.feed_mm_min = -1; });
  refused([](CirclePath& p) { p.to_deg = 400; });
  refused([](CirclePath& p) { p.to_deg = p.from_deg; });
  refused([](CirclePath& p) { p.overshoot_deg = 361; });
  refused([](CirclePath& p) { p.feed_in_mm = 100; });
  refused([](CirclePath& p) { p.plane = "AB"; });
}

}  // namespace
}  // namespace vernier::circle_path_test
