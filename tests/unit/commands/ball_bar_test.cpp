// SPDX-License-Identifier: GPL-3.0-or-later
// The ranked diagnostics of a ball bar in the result of compare.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::ball_bar_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

/// Circles of 100 mm in both senses: squareness 80 um/m, a backlash of 6 um of X, the bar 0.3 mm off its
/// place.
std::string circles(bool both) {
  std::string text = "X[mm],Y[mm],length[mm],cx[mm],cy[mm],cz[mm],feed[mm/min],t[s],run\n";
  double time = 0;
  for (const int sense : {1, -1}) {
    if (sense < 0 && !both) break;
    for (int k = 0; k < 720; ++k) {
      const double turned = sense * 2 * M_PI * (k + 0.5) / 720;
      const double x = 100 * std::cos(turned), y = 100 * std::sin(turned);
      // Half the play on either side, against the motion; the squareness leans Y over.
      const double moving = -sense * std::sin(turned) > 0 ? 1 : -1;
      const double at_x = x - 0.003 * moving + 80e-6 * y, at_y = y;
      const double length = std::hypot(at_x - 0.3, at_y);
      text += number_text(x) + "," + number_text(y) + "," + number_text(length) + ",0,0,0,1000," +
              number_text(time += 0.05) + (sense > 0 ? ",ccw\n" : ",cw\n");
    }
  }
  return text;
}

nlohmann::json compared(const std::string& rows) {
  const std::string folder = testing::TempDir() + "ball_bar_" + std::to_string(getpid());
  fs::create_directories(folder);
  write_file(folder + "/rows.csv", rows);
  const int status =
      std::system(("cd '" + folder +
                   "' && " VERNIER_BIN_DIR "/vernier compare " VERNIER_SOURCE_DIR
                   "/tables/machines/xy_circle.xml rows.csv --json r.json -o r.html >out.txt 2>&1")
                      .c_str());
  EXPECT_EQ(status, 0) << read_file(folder + "/out.txt");
  auto json = nlohmann::json::parse(read_file(folder + "/r.json"));
  fs::remove_all(folder);
  return json;
}

TEST(BallBar, DiagnosticsAreRankedByWhatTheyDoToTheCircle) {
  const auto table = compared(circles(true))["circular"][0]["diagnostics"];
  ASSERT_EQ(table.size(), 18u);  // twenty, without the two of where the bar stood
  EXPECT_EQ(table[0]["name"], "squareness");
  EXPECT_NEAR(std::abs(table[0]["value"].get<double>()), 80, 1);  // um/m
  EXPECT_NEAR(table[0]["effect_um"].get<double>(), 8, 0.2);       // 80e-6 * 100 mm * (sin cos: -1/2 to 1/2)
  EXPECT_EQ(table[1]["name"], "backlash of X");
  EXPECT_NEAR(std::abs(table[1]["value"].get<double>()), 6, 0.5);
  double all = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    all += table[i]["share"].get<double>();
    EXPECT_LE(table[i]["effect_um"], table[i > 0 ? i - 1 : 0]["effect_um"]);
  }
  EXPECT_NEAR(all, 1, 1e-9);
}

TEST(BallBar, OneSenseHasNoDiagnostics) {
  EXPECT_TRUE(compared(circles(false))["circular"][0]["diagnostics"].is_null());
}

}  // namespace
}  // namespace vernier::ball_bar_test
