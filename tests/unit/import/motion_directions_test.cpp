// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/order/motion_directions.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/unit/import/table_reading.h"

namespace vernier::motion_directions_test {

using namespace vernier::importer;
using importer_test::read;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MotionDirections, AnEndOfARunThatIsReadTwiceHasTheDirectionOfTheMotionToIt) {
  EXPECT_THAT(directions_by_motion({0, 1, 1, 0, 0}, {}), ElementsAre(1, 1, -1, -1, -1));
  EXPECT_THAT(directions_by_motion({0, 1, 1, 0}, {"a", "a", "b", "b"}), ElementsAre(1, 1, -1, -1));
  EXPECT_THAT(directions_by_motion({2, 2}, {}), ElementsAre(0, 0));
}

TEST(MotionDirections, TheLastMotionCountsAndNoneBeforeTheFirst) {
  EXPECT_THAT(directions_of_last_motion({0, 1, 1, 0.5, 0.505}, {}, 0.01), ElementsAre(0, 1, 1, -1, -1));
  EXPECT_THAT(directions_of_last_motion({0, 1, 0, 5}, {"a", "a", "b", "b"}, 0), ElementsAre(0, 1, 0, 1));
}

SheetWords from_order() {
  SheetWords words;
  words.directions = "from-order";
  return words;
}

TEST(MotionDirections, ASurveyGetsTheDirectionsOfItsAxes) {
  const std::string table = "X[mm],Y[mm],x[mm],y[mm]\n0,5,0,5\n100,5,100,5\n50,5,50,5\n50,9,50,9\n";
  const std::string text = read(table, from_order());
  EXPECT_THAT(text, HasSubstr("X[mm],Y[mm],x[mm],y[mm],dirX,dirY\n0,5,0,5,0,0\n100,5,100,5,1,0\n"
                              "50,5,50,5,-1,0\n50,9,50,9,-1,1\n"));
  EXPECT_THAT(text, HasSubstr("note: an axis without a column of directions has the direction of its last "
                              "motion"));
  EXPECT_THAT(read(table), HasSubstr("X[mm],Y[mm],x[mm],y[mm]\n")) << "only if the user asks for it";
}

TEST(MotionDirections, AStatedColumnAndTheRunsAreKept) {
  EXPECT_THAT(
      read("X[mm],Y[mm],dirX,run,x[mm]\n0,0,-1,a,0\n1,1,-1,a,1\n0,0,-1,b,0\n1,1,-1,b,1\n", from_order()),
      HasSubstr("X[mm],Y[mm],dirX,run,x[mm],dirY\n0,0,-1,a,0,0\n1,1,-1,a,1,1\n0,0,-1,b,0,0\n"
                "1,1,-1,b,1,1\n"));
  EXPECT_THAT(read("X[mm],x[mm]\n5,5.001\n5,5.002\n5,5.003\n", from_order()),
              HasSubstr("no axis of the table moves"));
}

TEST(MotionDirections, AProfileKeepsTheOption) {
  const SheetReading reading = read_as_sheet("X[mm],x[mm]\n0,0\n1,1\n2,2\n", "s.csv", from_order());
  const std::string profile = sheet_profile(reading.sheet, reading.table, reading.columns, reading.wishes);
  EXPECT_THAT(profile, HasSubstr("directions = from-order\n"));
  SheetWishes wishes;
  read_sheet_profile(wishes, profile, "p");
  EXPECT_TRUE(wishes.directions_from_order);
}

}  // namespace vernier::motion_directions_test
