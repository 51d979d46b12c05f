// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/time_base.h"

#include <gtest/gtest.h>

#include "tests/unit/timebase/circle_record.h"
#include "tools/fit/fit.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_csv.h"
#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/import/ballbar/time_repair.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"
#include "tools/timebase/revisit.h"

namespace vernier::time_base_test {

using namespace vernier::fit;
using namespace vernier::importer;
using namespace vernier::model;
using namespace vernier::timebase;
namespace {

using test::circle_record;
using test::CircleRun;
using test::repeating_error;

const std::string kReal = std::string(VERNIER_SOURCE_DIR) + "/tests/data/real/ur10e_ballbar/";

std::function<double()> white(std::uint64_t seed, double um) {
  return [random = std::mt19937_64(seed), normal = std::normal_distribution<double>(0, um)]() mutable {
    return normal(random);
  };
}

std::set<std::size_t> rows_from(std::size_t first, std::size_t count) {
  std::set<std::size_t> rows;
  for (std::size_t i = 0; i < count; ++i) rows.insert(first + i);
  return rows;
}

TEST(TimeBase, RealBallBarRecordBelongsToOtherInstants) {
  // GIVEN one turn in each sense, as the instrument's file cuts them out, and centre and radius fitted
  const Machine machine = read_machine(kReal + "machine.xml");
  const Measurement measurement = read_measurement({kReal + "meas.csv"}, machine);
  const FitResult fitted = fit::fit(machine, measurement);
  // WHEN nothing but that is known
  const TimeBaseFinding finding = examine_time_base(measurement, fitted.residual);
  // THEN the runs agree at the same rate in samples (1591 a turn both), not at 1442/1590 of it
  RecordProperty("why", finding.why);
  ASSERT_TRUE(finding.found) << finding.why;
  EXPECT_LT(finding.p_value, 1e-3);
  ASSERT_EQ(finding.matches.size(), 1u);
  const RunMatch& match = finding.matches[0].match;
  EXPECT_NEAR(match.implied.rate, -1442.0 / 1590, 1e-3);
  EXPECT_NEAR(match.best.rate, -1.0, 1e-9);
  EXPECT_GT(match.correlation, 0.6);
  EXPECT_LT(match.implied_correlation, 0.1);
  ASSERT_EQ(finding.closures.size(), 2u);
  EXPECT_NEAR(static_cast<double>(finding.closures[0].closure.rows), 1590 - 1573, 1);
}

TEST(TimeBase, WholeBallBarRecordRepeatsAtAnotherLag) {
  // GIVEN both turns of each sense, overshoot included
  const Machine machine = read_machine(kReal + "machine.xml");
  const BallbarFile file =
      read_b5r(std::string(VERNIER_SOURCE_DIR) + "/tests/data/ballbar/ur10e_xy_100mm.b5r");
  const Measurement measurement = parse_measurement(ballbar_csv({file}, {}).text, "import.csv", machine);
  const FitResult fitted = fit::fit(machine, measurement);
  const TimeBaseFinding finding = examine_time_base(measurement, fitted.residual);
  // THEN the lags are those found by hand: 1573 before angle 0, 1554 after it, 1591 clockwise
  ASSERT_TRUE(finding.found) << finding.why;
  EXPECT_LT(finding.p_value, 1e-6);
  int at_1573 = 0, at_1554 = 0, at_1591 = 0;
  for (const TimeBlock& block : finding.blocks) {
    if (block.correlation < 0.9) continue;
    at_1573 += block.run == 0 && std::abs(block.best_lag - 1573) < 2 ? 1 : 0;
    at_1554 += block.run == 0 && std::abs(block.best_lag - 1554) < 2 ? 1 : 0;
    at_1591 += block.run == 1 && std::abs(block.best_lag - 1591) < 3 ? 1 : 0;
  }
  EXPECT_GE(at_1573, 4);
  EXPECT_GE(at_1554, 5);
  EXPECT_GE(at_1591, 8);
  ASSERT_FALSE(finding.gaps.empty());
  EXPECT_EQ(finding.gaps[0].run, 0u);
  EXPECT_NEAR(finding.gaps[0].missing, 19.5, 1.5);
  // At the end of the first half circle of the second turn (2370), where the motion rings for 60 samples.
  EXPECT_NEAR(static_cast<double>(finding.gaps[0].row), 2370, 60);
}

TEST(TimeBase, RepairedRecordIsInTimeAndItsErrorRepeats) {
  // GIVEN the same record with its time base repaired
  const BallbarFile file =
      read_b5r(std::string(VERNIER_SOURCE_DIR) + "/tests/data/ballbar/ur10e_xy_100mm.b5r");
  const std::string csv = ballbar_csv({repair_time_base(file).file}, {}).text;
  const Machine circle = read_machine(kReal + "machine.xml");
  const Measurement measurement = parse_measurement(csv, "repaired.csv", circle);
  const FitResult plain = fit::fit(circle, measurement);
  // THEN nothing repeats at another place any more,
  EXPECT_FALSE(examine_time_base(measurement, plain.residual).found);
  // and a table of the path angle for each sense, fitted to one turn, holds on the other: 19 um of 51
  const Machine repeating = read_machine(kReal + "repeating.xml");
  const FitResult fitted = fit::fit(repeating, parse_measurement(csv, "repaired.csv", repeating));
  EXPECT_GT(*plain.check.rms_um, 45);
  EXPECT_LT(*fitted.after.rms_um, 9);
  EXPECT_LT(*fitted.check.rms_um, 21);
  EXPECT_GT(*fitted.check.rms_um, 10);  // two passes differ by 11 um: less would be its own rows
}

struct Loss {
  std::size_t row, count;
};

class TimeBaseLoss : public testing::TestWithParam<Loss> {};

TEST_P(TimeBaseLoss, IsFoundWhereAndHowMany) {
  // GIVEN three turns with an error that repeats (30 um), noise of 5 um, and some readings lost
  const auto [row, count] = GetParam();
  CircleRun run;
  run.turns = 3;
  run.lost = rows_from(row, count);
  const auto record = circle_record({run}, repeating_error(7, 30, 60), white(11, 5));
  const TimeBaseFinding finding = examine_time_base(record.measurement, record.residual);
  ASSERT_TRUE(finding.found) << finding.why;
  EXPECT_LT(finding.p_value, 1e-6);
  // THEN a gap of that size is reported there. A loss is seen where its pass meets the next or the last one.
  bool there = false;
  for (const TimeGap& gap : finding.gaps) {
    const bool size = std::abs(gap.missing - static_cast<double>(count)) <= 0.5 + 3 * gap.uncertainty;
    const bool place =
        std::abs(static_cast<double>(gap.row) - static_cast<double>(row)) <= 3 + 3 * gap.row_uncertainty;
    there = there || (size && place);
  }
  EXPECT_TRUE(there) << finding.why;
}

INSTANTIATE_TEST_SUITE_P(Places, TimeBaseLoss,
                         testing::Values(Loss{400, 20}, Loss{1400, 20}, Loss{1650, 7}, Loss{1300, 60},
                                         Loss{700, 4}));

TEST(TimeBase, WrongRateBetweenOppositeSensesIsFound) {
  // GIVEN one turn in each sense, the second computed with a turn that is a tenth too short and starts
  // elsewhere
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CircleRun forth{"CCW", +1, 1, 1591, 1591, 0, 0, {}}, back{"CW", -1, 0.906, 1591, 1442, 310, 360, {}};
    const auto record = circle_record({forth, back}, repeating_error(seed, 40, 30), white(seed, 10));
    const TimeBaseFinding finding = examine_time_base(record.measurement, record.residual);
    found += finding.found ? 1 : 0;
  }
  EXPECT_GE(found, 14);  // of 20: one turn each is little to tell from
}

TEST(TimeBase, SaysThatSinglePosesCannotTell) {
  CircleRun run;
  run.turns = 0.9;
  const auto record = circle_record({run}, repeating_error(3, 30, 60), white(5, 5));
  const TimeBaseFinding finding = examine_time_base(record.measurement, record.residual);
  EXPECT_FALSE(finding.found);
  EXPECT_EQ(finding.p_value, 1);
  EXPECT_NE(finding.why.find("cannot be tested"), std::string::npos);
}

TEST(Revisit, FindsTurnsAndNotTheWayBack) {
  // GIVEN a line travelled forth and back twice: each point comes again in the same sense after a full cycle
  Eigen::MatrixXd points(800, 1);
  for (int i = 0; i < 800; ++i) {
    const int phase = i % 400;
    points(i, 0) = phase < 200 ? phase : 400 - phase;
  }
  const Eigen::VectorXd lags = revisit_lags(points);
  for (int i = 5; i < 395; ++i) {
    if (i % 200 < 5 || i % 200 > 195) continue;
    ASSERT_NEAR(lags[i], 400, 1e-9) << i;
  }
  for (int i = 420; i < 800; ++i) ASSERT_TRUE(std::isnan(lags[i]) || i % 200 < 5 || i % 200 > 195) << i;
}

TEST(Revisit, PosesSetOneByOneAreNoPath) {
  // GIVEN a survey of scattered poses, measured twice over
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 1);
  Eigen::MatrixXd points(20000, 3);
  for (Eigen::Index i = 0; i < 10000; ++i) points.row(i) << place(random), place(random), place(random);
  points.bottomRows(10000) = points.topRows(10000).eval();
  EXPECT_TRUE(revisit_lags(points).array().isNaN().all());
  EXPECT_FALSE(map_paths(points.topRows(10000), points.bottomRows(10000)).has_value());
}

TEST(Revisit, MapsAPathOntoItsReverse) {
  Eigen::MatrixXd forth(500, 2), back(450, 2);
  for (int i = 0; i < 500; ++i) forth.row(i) << std::cos(0.012 * i), std::sin(0.012 * i);
  for (int i = 0; i < 450; ++i) back.row(i) << std::cos(6 - 0.0135 * i), std::sin(6 - 0.0135 * i);
  const auto map = map_paths(forth, back);
  ASSERT_TRUE(map.has_value());
  EXPECT_NEAR(map->rate, -0.012 / 0.0135, 1e-6);
  EXPECT_NEAR(map->offset, 6 / 0.0135, 1e-3);
}

}  // namespace
}  // namespace vernier::time_base_test
