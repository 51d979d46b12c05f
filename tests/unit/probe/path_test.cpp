// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/path.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::path_test {

using namespace vernier::probe;
using namespace vernier::text;
namespace {

ProbePath published() {
  ProbePath path;
  path.radius = 9.5255, path.clearance = 0.3 * 25.4, path.inch = true;
  path.name = "SPHERE", path.title = "SPHERE TEST PROBING";
  path.comments = {"Fri Mar 11, 1999",
                   "Tool 5: Touch-trigger probe w/ext. in 7.1\" boring bar holder.",
                   "Length: Z=-10.7015 X=-7.9315 Offset 5: Z=-0.1000 X=0.0200",
                   "Touch face of part, then MDI W2.2985 for PROBING START",
                   "P43 = PROBING START: Machine Z coordinate to which",
                   "probe moves from the \"standard\" initial machine coordinates",
                   "[X0, Z10].",
                   "Probe tip diameter = 0.197\"",
                   "Feedrate = 100 (inches per minute)",
                   "Touch face at Z-1.8, part zero is on dome surface.",
                   "Program probes 81 pts on SPHERE over 200 degrees"};
  return path;
}

TEST(ProbePath, IsThePublishedSphereProgramToTheLastCharacter) {
  EXPECT_EQ(probe_program(published(), Dialect::kTurning),
            read_file(VERNIER_SOURCE_DIR "/tests/data/probing/a1_sphere.nc"));
}

TEST(ProbePath, TouchesEveryDirectionAtEveryFeedInEveryDialect) {
  ProbePath path;
  path.radius = 12.5, path.clearance = 5, path.ball_radius = 2.5, path.from_deg = 0, path.to_deg = 330,
  path.step_deg = 30;
  path.elevations_deg = {0, 45, 90}, path.feeds = {60, 300, 1200};
  const auto count = [](const std::string& text, const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
  };
  for (const auto& [dialect, word] : {std::pair{Dialect::kLinuxcnc, "G38.2 "},
                                      {Dialect::kFanuc, "G31 "},
                                      {Dialect::kAerobasic, "PROBE ON X Y Z"}}) {
    const std::string text = probe_program(path, dialect);
    EXPECT_EQ(count(text, word), 3u * (12 + 12 + 1)) << word;
    EXPECT_EQ(count(text, "F1200"), 25u);
  }
  EXPECT_NE(probe_program(path, Dialect::kLinuxcnc).find("G38.2 X13.00000 Y0.00000 Z0.00000 F60\n"),
            std::string::npos);
}

std::string refusal(const ProbePath& path, Dialect dialect) {
  try {
    probe_program(path, dialect);
  } catch (const LimitNotMet& error) {
    return error.what();
  }
  return "";
}

// NISTIR 6415, 1999: at 2540 mm/min an approach of 5.1 mm, 2.5 mm beyond the surface.
TEST(ProbePath, IsRefusedWhereATouchWouldNotBeValid) {
  ProbePath path;
  path.radius = 12.5, path.clearance = 5.1, path.overtravel = 2.5, path.feeds = {2540};
  EXPECT_EQ(refusal(path, Dialect::kLinuxcnc), "");
  path.clearance = 5.0;
  EXPECT_NE(refusal(path, Dialect::kLinuxcnc).find("before the speed is constant"), std::string::npos);
  path.feeds = {200};
  EXPECT_EQ(refusal(path, Dialect::kLinuxcnc), "");
  path.clearance = 0.05;
  EXPECT_NE(refusal(path, Dialect::kFanuc), "");
  path.clearance = 5.1, path.overtravel = 50;
  EXPECT_NE(refusal(path, Dialect::kLinuxcnc).find("bends the stylus"), std::string::npos);
  path.feeds = {2540}, path.overtravel = 1;
  EXPECT_NE(refusal(path, Dialect::kLinuxcnc).find("has stopped before the contact"), std::string::npos);
  path.conditions.gain_per_s = 100;  // a stiffer loop follows closer
  EXPECT_EQ(refusal(path, Dialect::kLinuxcnc), "");
  path.overtravel = 50, path.unchecked = true;
  EXPECT_EQ(refusal(path, Dialect::kLinuxcnc), "");
  path = published();
  path.feeds = {100};  // in/min
  EXPECT_EQ(refusal(path, Dialect::kTurning), "");
}

TEST(ProbePath, RefusesAPathWithoutSense) {
  ProbePath path = published();
  path.step_deg = 0;
  EXPECT_THROW(probe_program(path, Dialect::kTurning), InputError);
  path = published();
  path.feeds = {100, -1};
  EXPECT_THROW(probe_program(path, Dialect::kLinuxcnc), InputError);
}

}  // namespace
}  // namespace vernier::path_test
