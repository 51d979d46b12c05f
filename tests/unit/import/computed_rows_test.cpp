// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that a spreadsheet computed, and measurements with a word of a statistic beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::computed_rows_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kAll =
    "X[mm],x[mm]\n0,-0.0032\n50,49.9994\n100,100.0013\n150,150.0024\n200,200.0033\n250,250.0036\n";

TEST(ComputedRows, AStatisticBesideTheTableRemovesNoReading) {
  const std::string text = read(
      "X [mm];Abw. X [µm];;Auswertung;Wert [µm]\n0;-3,2;;n;6\n50;-0,6;;Mittelwert;1,1\n100;1,3;;Stabw;2,6\n"
      "150;2,4;;Max;3,6\n200;3,3;;Min;-3,2\n250;3,6;;Spanne;6,8\n");
  EXPECT_THAT(text, AllOf(StartsWith(kAll), Not(HasSubstr("computed from the rows")),
                          HasSubstr("the columns \"Auswertung\", \"Wert [µm]\" have statistics")));
  EXPECT_THAT(read("X [mm];Abw. X [µm];Auswertung;Wert\n0;-3,2;Mittelwert;1,1\n50;-0,6;Stabw;2,6\n100;1,3;;\n"
                   "150;2,4;;\n200;3,3;;\n250;3,6;;\n"),
              StartsWith(kAll))
      << "without an empty column";
  SheetWords words;
  words.left = {"Auswertung"};
  EXPECT_THAT(read("X [mm];Abw. X "
                   "[µm];;Auswertung;Wert\n0;-3,2;;Mittelwert;1,1\n50;-0,6;;Stabw;2,6\n100;1,3;;Max;3,6\n"
                   "150;2,4;;Min;-3,2\n200;3,3;;;\n250;3,6;;;\n",
                   words),
              StartsWith(kAll));
}

TEST(ComputedRows, ARemarkAboutAMeasurementKeepsIt) {
  const std::string text = read(
      "X [mm];Abw. X [µm];Bemerkung\n0;-3,2;\n50;-0,6;warm\n100;1,3;\n150;2,4;\n200;3,3;Max\n250;3,6;\n");
  EXPECT_THAT(text,
              AllOf(HasSubstr("200,200.0033,Max\n"), HasSubstr("line 6: the word \"Max\" is a remark")));
}

TEST(ComputedRows, AStatisticOfThePositionsTooIsOmitted) {
  const std::string rows = "0;1,0;\n50;2,0;\n100;4,0;\n";
  EXPECT_THAT(read("X [mm];Abw. X [µm];Bem.\n" + rows + "50;2,33;Mittelwert\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.004\nnote"),
                    HasSubstr("line 5: the row \"Mittelwert\" is computed")));
  EXPECT_THAT(read("X [mm];Abw. X [µm];Bem.\n" + rows + ";2,33;Mittelwert\n"),
              StartsWith("X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.004\nnote"));
}

TEST(ComputedRows, OfAnUnknownKindAreRefused) {
  EXPECT_THAT(
      read("X [mm];Lauf;Abw. X [µm]\n0;1;1,0\n0;2;1,4\n0;Mittel;1,2\n50;1;2,0\n50;2;2,4\n50;Mittel;2,2\n"),
      StartsWith("X[mm],run,x[mm]\n0,1,0.001\n0,2,0.0014\n50,1,50.002\n50,2,50.0024\nnote"))
      << "the mean of each target";
  EXPECT_THAT(read("X [mm];Lauf;Abw. X [µm]\n0;1;1,0\n0;2;1,4\n0;Mittel;7,2\n50;1;2,0\n50;2;2,4\n"),
              AllOf(StartsWith("refused: s.csv:4: \"Mittel\""), HasSubstr("delete the row")));
}

}  // namespace
}  // namespace vernier::computed_rows_test
