// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that somebody typed with another decimal sign or another unit than the other cells of their column.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/sizes/typed_cells.h"

namespace vernier::typed_cells_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

TEST(TypedCells, RefusesManyLostDecimalSigns) {
  const std::string rows =
      "X [mm];dX [um]\n0;-07\n50;1,8\n100;13\n150;3,8\n200;33\n250;5,8\n300;53\n350;7,8\n400;73\n450;9,8\n";
  EXPECT_THAT(read(rows), AllOf(StartsWith("refused: s.csv:2: \"-07\": this cell and 4 more"),
                                HasSubstr("1/10 of their values agrees"),
                                HasSubstr("give --deviation \"X[um]=dX [um]\"")));
  SheetWords words;
  words.deviations = {"X[um]=dX [um]"};
  EXPECT_THAT(read(rows, words), AllOf(HasSubstr("100,100.013"), HasSubstr("note: line 2, \"-07\"")));
}

TEST(TypedCells, RefusesACellThatBeginsWithZeroAmongDecimals) {
  EXPECT_THAT(read("X [mm];dX [um]\n0;3,1\n50;3,4\n100;1,8\n150;-04\n200;-37\n250;-84\n"),
              StartsWith("refused: s.csv:5: \"-04\": this cell and 2 more"));
}

TEST(TypedCells, ReadsNumbersWithTwoDigits) {
  EXPECT_THAT(read("X [mm];dX [um]\n0;-6\n50;9,9\n100;12\n150;-3,4\n200;-15\n250;7,1\n300;18\n350;-11\n"),
              StartsWith("X[mm]"));
}

TEST(TypedCells, ReadsWholeNumbersAmongDecimals) {
  // Trailing zeros cut off, and values with two digits in a curve of the axis.
  EXPECT_THAT(read("X [mm];dX [um]\n0;0,3\n50;12\n100;0,4\n150;15\n200;11,7\n250;13\n300;0,5\n350;12,5\n"),
              AllOf(StartsWith("X[mm]"), Not(HasSubstr("note"))));
  EXPECT_THAT(read("X [mm];dX [um]\n0;1,8\n50;3,8\n100;7,9\n150;13\n200;17\n250;22\n300;18\n350;9,5\n"),
              StartsWith("X[mm]"));
}

TEST(TypedCells, RefusesATargetOutOfOrder) {
  EXPECT_THAT(read("X [mm];dX [um]\n0,5;1\n50,5;2\n100,5;3\n1505;4\n200,5;3\n250,5;2\n"),
              AllOf(StartsWith("refused: s.csv:5: \"1505\": this position is out of order between 100.5 and "
                               "200.5, and 1/10 of it is in order"),
                    HasSubstr("--column \"X[mm]=X [mm]\"")));
  EXPECT_THAT(read("X [mm];dX [um]\n0;1\n50;2\n100;3\n150;4\n200;3\n2500;2\n"),
              StartsWith("refused: s.csv:7: \"2500\": this position is out of order behind 200"));
}

TEST(TypedCells, FindsMisplacedTargetsInAnOrderOnly) {
  const auto misplaced = misplaced_targets({10, 20, 30, 4, 50, 60, 50, 40, 300, 20, 10});
  ASSERT_EQ(misplaced.size(), 2U);
  EXPECT_EQ(misplaced[0].index, 3U);
  EXPECT_EQ(misplaced[0].times, 10);
  EXPECT_EQ(misplaced[1].index, 8U);
  EXPECT_EQ(misplaced[1].times, 0.1);
  // A return to the first target, a grid, random positions, and the reading 0 at the end of a way back.
  EXPECT_TRUE(misplaced_targets({10, 30, 50, 70, 90, 10, 110, 130}).empty());
  EXPECT_TRUE(misplaced_targets({10, 20, 30, 40, 50, 10}).empty());
  EXPECT_TRUE(misplaced_targets({0, 0, 0, 200, 200, 200, 400, 400, 400}).empty());
  EXPECT_TRUE(misplaced_targets({7, 310, 44, 120, 95, 410, 12, 130, 55, 260}).empty());
  EXPECT_TRUE(misplaced_targets({200.0148, 150.0140, 100.0138, 50.0100, 0.0062}).empty());
}

TEST(TypedCells, RefusesTargetsInMetresBelowMillimetres) {
  const std::string rows =
      "X [mm];dX [um]\n0;1\n50;2\n100;3\n150;4\n200;3\n250;2\n0,300;3\n0,350;2\n0,400;1\n";
  EXPECT_THAT(read(rows), AllOf(StartsWith("refused: s.csv:8: \"0,300\": in this line and in 2 more"),
                                HasSubstr("(m and mm)")));
  EXPECT_THAT(read("X [mm];dX [um]\n0;1\n50;2\n100;3\n0,150;4\n0,200;3\n0,250;2\n0,300;3\n"),
              StartsWith("refused: s.csv:5: \"0,150\": in this line and in 3 more"));
  // Fine steps near zero have more decimals too.
  EXPECT_THAT(read("X [mm];dX [um]\n0;1\n0,005;2\n0,010;3\n50;4\n100;3\n150;2\n200;3\n250;2\n"),
              StartsWith("X[mm]"));
}

TEST(TypedCells, NotesSingleCellsInAnotherUnit) {
  EXPECT_THAT(read("X [mm];dX [um]\n0;0,7\n50;1,8\n100;2,3\n150;0,0038\n200;3,3\n250;5,8\n300;5,3\n"),
              HasSubstr("note: line 5, \"0,0038\": this cell of \"dX [um]\" has more decimals"));
  EXPECT_THAT(read("X [mm];dX [um]\n0;0,7\n50;1,8\n100;2,3\n150;3,852\n200;3,3\n250;5,8\n300;5,3\n"),
              Not(HasSubstr("note")));
}

/// A survey of two runs in both directions, with a lead error, a reversal error and a scatter of 0.5 um.
std::string survey(const std::string& in_place_of = "", const std::string& typed = "") {
  std::string rows =
      "X [mm];1+ [um];1- [um];2+ [um];2- [um]\n"
      "0;-0,4;3,1;0,3;2,7\n50;-1,9;1,2;-1,2;1,6\n100;-2,6;0,1;-3,3;0,7\n150;-4,8;-1,6;-4,1;-0,8\n"
      "200;-5,5;-2,9;-6,2;-2,2\n250;-7,7;-4,1;-7,2;-4,6\n300;-8,6;-5,8;-9,3;-5,1\n350;-10,9;-6,8;-10,2;-7,4\n"
      "400;-11,7;-8,9;-12,4;-8,3\n";
  const auto at = in_place_of.empty() ? std::string::npos : rows.find(in_place_of);
  return at == std::string::npos ? rows : rows.replace(at, in_place_of.size(), typed);
}

TEST(TypedCells, NotesALostMinusSign) {
  EXPECT_THAT(read(survey()), Not(HasSubstr("note")));
  EXPECT_THAT(
      read(survey("-7,7", "7,7")),
      HasSubstr("note: line 7, \"7,7\": the negative value agrees with the other readings of \"1+ [um] to "
                "2- [um]\", and this value does not: is a minus sign lost?"));
  // One run without directions: by the readings beside it.
  std::string one = "X [mm];dX [um]\n";
  for (const char* const row : {"0;-3,1", "50;-3,6", "100;-4,4", "150;-4,7", "200;5,6", "250;-6,1",
                                "300;-6,4", "350;-7,3", "400;-7,6", "450;-8,4"})
    one += std::string(row) + "\n";
  EXPECT_THAT(read(one), HasSubstr("note: line 6, \"5,6\": "));
  // A change of the sign by less than the scatter cannot be seen.
  EXPECT_THAT(read(survey("-0,4", "0,4")), Not(HasSubstr("note")));
}

TEST(TypedCells, NotesAGainedMinusSign) {
  std::string rows;
  for (const char* const row :
       {"0;6,3;14,1", "50;10,1;17,2", "100;13,0;20,9", "150;15,3;22,6", "200;15,3;23,1", "250;15,8;23,4",
        "300;14,9;23,0", "350;15,1;22,4", "400;15,5;23,2", "450;17,2;24,8", "500;-19,6;27,1"})
    rows += std::string(row) + "\n";
  EXPECT_THAT(read("X [mm];1+ [um];1- [um]\n" + rows),
              HasSubstr("note: line 12, \"-19,6\": the positive value agrees with the other readings of"));
  // A run back begins at the position where the run out ended, and a second run where the first one ended.
  EXPECT_THAT(read("Pos X [mm];Abw. X [um];Lauf\n0;-3,7;1\n50;0,1;1\n100;3,0;1\n150;5,3;1\n200;5,3;1\n"
                   "200;12,8;1\n150;11,1;1\n100;9,5;1\n50;6,8;1\n0;3,1;1\n0;-3,7;2\n50;0,8;2\n100;3,5;2\n"
                   "150;5,4;2\n200;6,1;2\n200;11,7;2\n150;12,0;2\n100;9,3;2\n50;6,0;2\n0;2,5;2\n"),
              Not(HasSubstr("minus sign")));
}

/// Two runs in both directions with a column of runs. `factor`: of the deviations of the second run.
std::string runs_below(double factor, const std::string& fourth = "150") {
  const double first[] = {-3.7, 0.1, 3.0, 5.3, 5.3, 5.8}, back[] = {13.1, 11.5, 11.9, 12.8, 11.1, 9.5};
  std::string rows = "X [mm],Abw. X [um],Richtung,Lauf\n";
  for (int run = 1; run < 3; ++run)
    for (int way = 0; way < 2; ++way)
      for (int k = 0; k < 6; ++k) {
        const int at = way == 0 ? k : 5 - k;
        const double value = ((way == 0 ? first : back)[k] + 0.3 * ((k + run) % 3)) * (run == 2 ? factor : 1);
        rows += (run == 1 && way == 0 && k == 3 ? fourth : std::to_string(50 * at)) + "," +
                std::to_string(value) + (way == 0 ? ",hin," : ",zurück,") + std::to_string(run) + "\n";
      }
  return rows;
}

TEST(TypedCells, NotesARunWithTheOppositeSign) {
  EXPECT_THAT(read(runs_below(1)), Not(HasSubstr("opposite sign")));
  EXPECT_THAT(read(runs_below(-1)),
              HasSubstr("the deviations of run 2 have the sizes of those of run 1 at all "
                        "common positions, and the opposite sign"));
  // Both directions of a machine whose backlash is centred are no opposite runs.
  EXPECT_THAT(
      read("X [mm],Abw. X [um],Lauf\n0,5.1,1\n50,5.3,1\n100,4.8,1\n150,5.2,1\n200,5,1\n250,5.1,1\n"
           "300,5.2,1\n350,4.9,1\n350,-5,2\n300,-5.2,2\n250,-4.9,2\n200,-5.1,2\n150,-5,2\n100,-4.9,2\n"
           "50,-5.2,2\n0,-5,2\n"),
      Not(HasSubstr("opposite sign")));
}

TEST(TypedCells, NotesATargetThatNoOtherRunHas) {
  EXPECT_THAT(read(runs_below(1)), Not(HasSubstr("target")));
  for (const char* const typed : {"510", "105"})
    EXPECT_THAT(read(runs_below(1, typed)),
                HasSubstr(std::string("note: line 5, \"") + typed +
                          "\": no other run has this target of X, and all other runs have 150"));
}

TEST(TypedCells, NotesACellInMillimetresByItsValueOrItsDecimals) {
  EXPECT_THAT(read(survey("-11,7", "-0,0117")), HasSubstr("note: line 10, \"-0,0117\": this cell of"));
  EXPECT_THAT(read(survey("-1,6", "-0,0016")), HasSubstr("note: line 5, \"-0,0016\": this cell of"));
  EXPECT_THAT(read(survey("-10,9", "-0,01")),
              HasSubstr("note: line 9, \"-0,01\": 1000 times this value agrees"));
}

TEST(TypedCells, NotesARunOfTenTimesTheSize) {
  EXPECT_THAT(
      read("X [mm];Lauf 1 [um];Lauf 2 [um]\n0;-0,7;-3\n50;1,8;22\n100;1,3;17\n150;3,8;42\n200;3,3;37\n"),
      HasSubstr("note: line 2, \"-3\": the deviations of run 2 are about 10 times those of run 1"));
  EXPECT_THAT(
      read("X [mm];Lauf 1 [um];Lauf 2 [um]\n0;-0,7;3\n50;1,8;-12\n100;1,3;17\n150;3,8;-4\n200;3,3;9\n"),
      Not(HasSubstr("times those of")));
}

}  // namespace
}  // namespace vernier::typed_cells_test
