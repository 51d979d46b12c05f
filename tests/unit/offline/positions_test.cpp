// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/positions.h"

#include <gtest/gtest.h>

#include "tests/unit/offline/machine.h"
#include "tools/format/csv_file.h"
#include "tools/kinematics/at.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::offline_test {

using namespace vernier::model;
using namespace vernier::offline;
using namespace vernier::format;
using namespace vernier::text;
namespace {

std::string list_corrected(const std::string& text, bool back = false) {
  const Machine machine = bridge();
  Corrector corrector(machine, {.with_rotary = false, .back = back});
  return corrected_positions(text, "p.csv", at_rest(machine), corrector);
}

TEST(Positions, ComeToTheIdealPointAndBack) {
  const std::string there =
      list_corrected("# a list\nname,X[mm],dirY,Y[mm],Z[mm]\n\"a, b\",100,1,50,-20\nc,333.3,-1,60,-30\n");
  const CsvFile csv = parse_csv(there, "there");
  ASSERT_EQ(csv.rows.size(), 2U);
  EXPECT_EQ(csv.rows[0][0], "a, b");
  const Machine machine = bridge();
  States states = make_states(2, 3, {});
  for (Eigen::Index row = 0; row < 2; ++row)
    for (const auto& [axis, column] : {std::pair{0, 1}, {1, 3}, {2, 4}})
      states.axis[static_cast<std::size_t>(axis)][row] =
          *parse_number(csv.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
  states.direction[1] << 1, -1;
  const Eigen::Matrix3Xd actual = forward(machine, states).position;
  EXPECT_LT((actual.col(0) - Eigen::Vector3d(100, 80, -100)).norm(), 1e-6);
  EXPECT_LT((actual.col(1) - Eigen::Vector3d(333.3, 90, -110)).norm(), 1e-6);
  EXPECT_GT(std::abs(states.axis[0][0] - 100), 0.001);
  const CsvFile again = parse_csv(list_corrected(there, true), "back");
  EXPECT_NEAR(*parse_number(again.rows[1][1]), 333.3, 1e-6);
}

TEST(Positions, ConvertedBackMayBeCorrectedAgain) {
  // GIVEN a corrected list
  const std::string there = list_corrected("# a list\nX[mm],Y[mm],Z[mm]\n100,50,-20\n");
  // WHEN it is converted back
  const std::string back = list_corrected(there, true);
  // THEN it is marked as such, and only a second conversion is refused
  EXPECT_EQ(back.find(kCorrectedMark), std::string::npos);
  EXPECT_NE(back.find("# a list\n"), std::string::npos);
  EXPECT_THROW(list_corrected(back, true), InputError);
  const std::string again = list_corrected(back);
  EXPECT_EQ(again.find(kBackMark), std::string::npos);
  EXPECT_THROW(list_corrected(again), InputError);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(*parse_number(parse_csv(again, "again").rows[0][axis]),
                *parse_number(parse_csv(there, "there").rows[0][axis]), 1e-6);
}

TEST(Positions, TargetsAreSolvedFirst) {
  const CsvFile csv = parse_csv(list_corrected("x[mm],y[mm],z[mm]\n100,80,-100\n"), "targets");
  EXPECT_EQ(csv.columns[0].name, "X");
  EXPECT_NEAR(*parse_number(csv.rows[0][0]), 100, 0.1);
  EXPECT_NE(*parse_number(csv.rows[0][0]), 100);
  EXPECT_THROW(list_corrected("x[mm],y[mm],z[mm]\n9000,80,-100\n"), LimitNotMet);
}

TEST(Positions, TargetsOfAProgramArePlacedWithSixDegreesOfFreedom) {
  const Machine machine = bridge();
  const auto positions = [&](const std::string& text, const std::optional<Eigen::Isometry3d>& place) {
    Corrector corrector(machine, {});
    const CsvFile csv =
        parse_csv(corrected_positions(text, "p.csv", at_rest(machine), corrector, place), "out");
    return Eigen::Vector3d(*parse_number(csv.rows[0][0]), *parse_number(csv.rows[0][1]),
                           *parse_number(csv.rows[0][2]));
  };
  // By hand: rZ = 90 turns x to y, rX = 90 then turns y to z.
  const Eigen::Isometry3d place = kinematics::placement("100,80,-130,90,0,90", "place");
  EXPECT_NEAR((positions("x[mm],y[mm],z[mm]\n30,0,0\n", place) -
               positions("x[mm],y[mm],z[mm]\n100,80,-100\n", std::nullopt))
                  .norm(),
              0, 1e-6);
  EXPECT_THROW(positions("X[mm],Y[mm],Z[mm]\n1,2,-3\n", place), InputError);
}

TEST(Positions, AreRefusedASecondTimeAndWithoutAnAxis) {
  const std::string text = "X[mm],Y[mm],Z[mm]\n1,2,-3\n";
  EXPECT_THROW(list_corrected(list_corrected(text)), InputError);
  EXPECT_THROW(list_corrected("X[mm],Y[mm]\n1,2\n"), InputError);
  EXPECT_THROW(list_corrected("X[mm],Y[mm],Z[mm]\n1,2,three\n"), InputError);
}

}  // namespace
}  // namespace vernier::offline_test
