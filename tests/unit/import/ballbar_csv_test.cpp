// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_csv.h"
#include "tools/import/ballbar/ballbar_motion.h"

namespace vernier::ballbar_csv_test {

using namespace vernier::importer;
namespace {

const BallbarFile& the_file() {
  static const BallbarFile kFile = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  return kFile;
}

// Rows of a measurement file by column name, as text.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) continue;
    const auto row = cells(line);
    if (names.empty()) {
      names = row;
      continue;
    }
    EXPECT_EQ(row.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = row.at(i);
  }
  return rows;
}

TEST(BallbarCsv, HasEverySampleOnceWithItsRole) {
  const BallbarCsv csv = ballbar_csv({the_file()}, {});
  EXPECT_EQ(csv.rows, 6158u);
  EXPECT_EQ(csv.fit_rows, 3032u);
  EXPECT_EQ(csv.check_rows, 3126u);
  EXPECT_EQ(csv.run_labels, (std::vector<std::string>{"CCW", "CW"}));
  const auto rows = rows_of(csv.text);
  ASSERT_EQ(rows.size(), 6158u);
  EXPECT_FALSE(rows[0].contains("Z[mm]"));
  std::map<std::string, int> count;
  for (const auto& row : rows) ++count[row.at("run") + " " + row.at("role") + " " + row.at("sense")];
  EXPECT_EQ(count,
            (std::map<std::string, int>{
                {"CCW fit 1", 1590}, {"CCW check 1", 1592}, {"CW fit -1", 1442}, {"CW check -1", 1534}}));
}

TEST(BallbarCsv, MotionIsThatOfItsOwnPositions) {
  // A second derivation: velocity and acceleration against central differences of the written positions and
  // clock.
  const auto rows = rows_of(ballbar_csv({the_file()}, {}).text);
  const auto at = [&](std::size_t i, const char* name) { return std::stod(rows.at(i).at(name)); };
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    if (rows[i - 1].at("run") != rows[i + 1].at("run")) continue;
    const double step_s = at(i + 1, "t[s]") - at(i, "t[s]");
    ASSERT_NEAR(step_s, 0.005, 1e-9);
    const double feed_mm_s = at(i, "feed[mm/min]") / 60;
    for (const char* axis : {"X", "Y"}) {
      const std::string position = std::string(axis) + "[mm]", v = std::string("v") + axis + "[mm/s]",
                        a = std::string("a") + axis + "[mm/s^2]";
      const double before = at(i - 1, position.c_str()), here = at(i, position.c_str()),
                   after = at(i + 1, position.c_str());
      // Central differences of a circle are short by (step angle)^2/6 and /12: 3e-6; positions are written to
      // 1e-7 mm.
      ASSERT_NEAR(at(i, v.c_str()), (after - before) / (2 * step_s), 5e-6 * feed_mm_s + 2e-5) << i;
      ASSERT_NEAR(at(i, a.c_str()), (after - 2 * here + before) / (step_s * step_s), 3e-4 + 0.02) << i;
      const std::string dir = std::string("dir") + axis, since = std::string("since") + axis + "[mm]";
      if (std::abs(at(i, v.c_str())) > 1e-6) {
        ASSERT_EQ(at(i, dir.c_str()), at(i, v.c_str()) > 0 ? 1 : -1) << i;
      }
      const bool reversed = at(i, dir.c_str()) != at(i - 1, dir.c_str());
      if (!reversed) {
        ASSERT_NEAR(at(i, since.c_str()) - at(i - 1, since.c_str()), std::abs(here - before), 1e-6) << i;
      }
      if (reversed) {
        ASSERT_LT(at(i, since.c_str()), std::abs(here - before) + 0.01) << i;
      }
    }
    ASSERT_NEAR(std::hypot(at(i, "X[mm]"), at(i, "Y[mm]")), 100, 1e-6);
    ASSERT_NEAR(at(i, "curv[1/mm]"), 0.01, 1e-12);
  }
}

TEST(BallbarCsv, CircularNumbersComeBackFromItsRows) {
  // GIVEN the written rows, read as any measurement would be
  std::map<std::string, CircularPass> passes;
  for (const auto& row : rows_of(ballbar_csv({the_file()}, {}).text)) {
    if (row.at("role") != "fit") continue;
    CircularPass& pass = passes[row.at("run")];
    pass.direction = std::stoi(row.at("sense"));
    const double degrees =
        std::atan2(std::stod(row.at("Y[mm]")), std::stod(row.at("X[mm]"))) * 180 / std::acos(-1.0);
    pass.angle_deg.push_back(degrees < 0 ? degrees + 360 : degrees);
    pass.deviation_mm.push_back(std::stod(row.at("length[mm]")) - 100);
  }
  const CircularResult circle = analyse_circle(100, {passes.at("CCW"), passes.at("CW")});
  // THEN they give the printed numbers
  EXPECT_NEAR(*circle.bidirectional_um, 437.4, 0.05);
  EXPECT_NEAR(circle.hysteresis->um, 313.7, 0.05);
  EXPECT_NEAR(circle.hysteresis->deg, 199.34813, 0.5e-5);
}

TEST(BallbarCsv, SecondRunStartsAfterThePauseAsked) {
  const auto start_of_cw = [](double pause_s) {
    for (const auto& row : rows_of(ballbar_csv({the_file()}, {pause_s}).text)) {
      if (row.at("run") == "CW") return std::stod(row.at("t[s]"));
    }
    return -1.0;
  };
  EXPECT_NEAR(start_of_cw(0), 3182 / 200.0, 1e-9);
  EXPECT_NEAR(start_of_cw(60), 3182 / 200.0 + 60, 1e-9);
}

TEST(BallbarCsv, TwoPlanesShareAxesAndKeepRunsApart) {
  BallbarFile other = the_file();
  other.path = "yz, second.b5r";
  other.axis_a = "Y";
  other.axis_b = "Z";
  const BallbarCsv csv = ballbar_csv({the_file(), other}, {});
  const auto rows = rows_of(csv.text);
  ASSERT_EQ(rows.size(), 2 * 6158u);
  EXPECT_EQ(csv.run_labels, (std::vector<std::string>{"ur10e_xy_100mm CCW", "ur10e_xy_100mm CW",
                                                      "yz_ second CCW", "yz_ second CW"}));
  EXPECT_EQ(rows.front().at("Z[mm]"), "0");
  EXPECT_EQ(rows.back().at("X[mm]"), "0");
  EXPECT_EQ(rows.back().at("Y[mm]"), rows[6157].at("X[mm]"));
  EXPECT_EQ(rows.back().at("Z[mm]"), rows[6157].at("Y[mm]"));
}

TEST(CirclePoint, SampleOnTheReversalKeepsTheSenseThatLedThere) {
  // 1590 samples a turn put sample 397 exactly on 90 deg, where Y reverses from + to -.
  const BallbarRun& run = the_file().runs[0];
  const CirclePoint on = circle_point(the_file(), run, run.start + 397),
                    after = circle_point(the_file(), run, run.start + 398);
  ASSERT_NEAR(on.angle_deg, 90, 1e-9);
  EXPECT_EQ(on.direction[1], +1);
  EXPECT_NEAR(on.since_mm[1], 200, 1e-9);
  EXPECT_EQ(after.direction[1], -1);
  EXPECT_LT(after.since_mm[1], 0.01);
}

}  // namespace
}  // namespace vernier::ballbar_csv_test
