// SPDX-License-Identifier: GPL-3.0-or-later
// Rows, cells and titles beside the readings: remarks, results below the table, computed columns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::sheet_remarks_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

TEST(SheetRemarks, OmitTheCellOfTheRunThatTheyName) {
  EXPECT_THAT(
      read("X [mm];Lauf 1 [um];Lauf 2 [um];Bemerkung\n0;1;2;\n50;2;3;Lauf 2 ungültig\n100;3;4;\n"),
      AllOf(HasSubstr("50,\"Lauf 2 ungültig\",1,50.002"), Not(HasSubstr("50.003")),
            HasSubstr("100,,2,100.004"),
            HasSubstr("note: line 3: this row says \"Lauf 2 ungültig\", and its cell of \"Lauf 2 [um]\" is "
                      "omitted")));
  EXPECT_THAT(read("X [mm];hin [um];zurück [um];Bemerkung\n0;1;2;\n50;2;3;zurück ungültig\n100;3;4;\n"),
              AllOf(HasSubstr("50.002"), Not(HasSubstr("50.003"))));
}

TEST(SheetRemarks, AboutAnotherReadingOmitNothing) {
  EXPECT_THAT(
      read("X [mm];dX [um];Bemerkung\n0;1;\n50;2;Wiederholung, da erste ungültig war\n100;3;\n"),
      AllOf(HasSubstr("50.002"), HasSubstr("is about another reading, and this row is read; if its own "
                                           "reading is invalid, write \"ungültig\" alone")));
  EXPECT_THAT(read("X [mm];dX [um];Bemerkung\n0;1;\n50;2;ungültig, durch Wiederholung ersetzt\n100;3;\n"),
              Not(HasSubstr("50.002")));
}

TEST(SheetRemarks, ResultsBelowTheTableAreOmitted) {
  EXPECT_THAT(read("X [mm],Deviation X [um]\n0,1\n50,2\n100,3\nMean,2\nA =,12.1\nReversal B,0.2\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.003\nnote"),
                    HasSubstr("line 6: the row \"A =\" is computed")));
  EXPECT_THAT(read("X (mm);Écart X (um)\n0;1\n50;2\n100;3\nÉcart-type;1,2\n"),
              StartsWith("X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.003\nnote"));
  // A mistyped number is no name of a result.
  EXPECT_THAT(read("X [mm],Deviation X [um]\n0,1\n50,2\n100,3\n1OO,4\nMean,2\n"),
              StartsWith("refused: s.csv:5: \"1OO\""));
}

TEST(SheetRemarks, RefuseACountBelowTheTable) {
  const std::string rows = "X [mm];dX [um]\n0;1\n50;2\n100;3\n150;4\n200;3\n";
  EXPECT_THAT(read(rows + "\n\n5;3,4\n"), StartsWith("refused: s.csv:9: \"5\": this row is behind an empty "
                                                     "line, and \"X [mm]\" is not in the order"));
  EXPECT_THAT(read(rows + "\n250;3\n"), HasSubstr("250,250.003"));
  EXPECT_THAT(read(rows + "\n0;1\n"), HasSubstr("0,0.001\n"));
}

TEST(SheetRemarks, ADifferenceBesideRunsIsNoReading) {
  const std::string sheet =
      "X [mm],Run 1 [um],Run 2 [um],Difference [um],Average [um]\n0,-0.7,-0.3,0.4,-0.5\n50,1.8,2.2,0.4,2.0\n"
      "100,1.3,1.7,0.4,1.5\n150,3.8,4.2,0.4,4.0\n";
  EXPECT_THAT(read(sheet), AllOf(StartsWith("X[mm],run,x[mm]\n0,1,-0.0007\n"), HasSubstr("150,2,150.0042"),
                                 HasSubstr("the column \"Difference [um]\" is the difference between \"Run 1 "
                                           "[um]\" and \"Run 2 [um]\" and is omitted")));
  SheetWords words;
  words.left = {"Difference [um]"};
  EXPECT_THAT(read(sheet, words), StartsWith("X[mm],run,x[mm]\n0,1,-0.0007\n"));
}

TEST(SheetRemarks, ATitleWithAnAxisStatesTheDirection) {
  SheetWords words;
  words.table = 2;
  EXPECT_THAT(read("Achse X vor\nPos [mm];Abw [um]\n0;1\n50;2\n100;3\nAchse X zurück\nPos [mm];Abw "
                   "[um]\n100;4\n50;3\n0;2\n",
                   words),
              AllOf(StartsWith("X[mm],x[mm],dirX\n100,100.004,-1\n"),
                    HasSubstr("the title \"Achse X zurück\" states the approach direction -")));
}

TEST(SheetRemarks, ATitleStatesTheDirectionOfTheOnlyTable) {
  const std::string up = "X [mm];dX [um]\n0;1\n50;2\n100;3\n", down = "X [mm];dX [um]\n100;1\n50;2\n0;3\n";
  for (const char* const title : {"X+", "Hinfahrt", "Achse X +", "Richtung: X+", "+X", "forward"})
    EXPECT_THAT(
        read(std::string(title) + "\n" + up),
        AllOf(StartsWith("X[mm],x[mm],dirX\n0,0.001,1\n"),
              HasSubstr(std::string("the title \"") + title + "\" states the approach direction + of")));
  EXPECT_THAT(read("X-\n" + down), StartsWith("X[mm],x[mm],dirX\n100,100.001,-1\n"));
  EXPECT_THAT(read("Lauf 2, X-\n" + down), StartsWith("X[mm],x[mm],dirX,run\n100,100.001,-1,2\n"));
  // A way of the survey is the way of the rows; a sign of the axis is used as written, with a note.
  EXPECT_THAT(read("Hinfahrt\n" + down), StartsWith("X[mm],x[mm],dirX\n100,100.001,-1\n"));
  EXPECT_THAT(read("X+\n" + down), HasSubstr("contradict the order of the rows"));
  // Runs without directions of their own.
  EXPECT_THAT(read("X+\nX [mm];Lauf 1 [um];Lauf 2 [um]\n0;1;2\n50;2;3\n100;3;4\n"),
              StartsWith("X[mm],run,x[mm],dirX\n0,1,0.001,1\n"));
  for (const char* const title : {"-", "Pos", "auf", "Messung 3", "Achse X", "Richtung X- und X+"})
    EXPECT_THAT(read(std::string(title) + "\n" + up),
                AllOf(StartsWith("X[mm],x[mm]\n"), Not(HasSubstr("states"))))
        << title;
  EXPECT_THAT(read("Hinfahrt\nX [mm];dX [um]\n0;1\n50;2\n100;3\n100;4\n50;3\n0;2\n"),
              AllOf(StartsWith("X[mm],x[mm]\n"), HasSubstr("the rows of the table go in both")));
}

TEST(SheetRemarks, LinesBetweenTheRowsStateTheDirection) {
  const std::string rows =
      "X[mm],x[mm],dirX\n0,0.001,1\n50,50.002,1\n100,100.003,1\n100,100.004,-1\n50,50.003,"
      "-1\n0,0.002,-1\nnote: the lines \"";
  for (const auto& [forth, back] : {std::pair("Hinfahrt", "Rückfahrt"), {"X+", "X-"}}) {
    const std::string one = std::string(forth) + "\n0;1\n50;2\n100;3\n",
                      two = std::string(back) + "\n100;4\n50;3\n0;2\n";
    EXPECT_THAT(read("Achse X\nPos [mm];Abw [um]\n" + one + two), StartsWith(rows + forth)) << forth;
    EXPECT_THAT(read("Achse X\nPos [mm];Abw [um]\n" + one + "\n" + two), StartsWith(rows + forth)) << forth;
  }
  EXPECT_THAT(read("X [mm];dX [um]\nLauf 1\n0;1\n50;2\nLauf 2\n0;3\n50;4\n"),
              StartsWith("X[mm],x[mm],run\n0,0.001,1\n50,50.002,1\n0,0.003,2\n"));
}

TEST(SheetRemarks, DirectionsAboveTwoTablesSideBySide) {
  for (const char* const titles : {"X+;;X-;", "Hinfahrt;;Rückfahrt;"})
    EXPECT_THAT(read("Achse X\n" + std::string(titles) +
                     "\nPos [mm];Abw [um];Pos [mm];Abw [um]\n0;1;100;4\n50;2;50;3\n100;3;0;2\n"),
                StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.002\n100,1,1,100.003\n100,-1,1,"
                           "100.004\n"))
        << titles;
}

TEST(SheetRemarks, AnEmptyPositionIsNotFilledByTheOneAbove) {
  EXPECT_THAT(read("X [mm];dX [um]\n0;1\n50;2\n100;3\n;2\n"),
              AllOf(StartsWith("refused: s.csv:5"), HasSubstr("write the position into this cell"),
                    Not(HasSubstr("--fill"))));
  EXPECT_THAT(read("X [mm];dX [um]\n0;1\n;2\n100;3\n;2\n"), HasSubstr("give --fill \"X [mm]\""));
}

TEST(SheetRemarks, CellsWithUnitsNameTheUnit) {
  EXPECT_THAT(read("X [mm];Abweichung\n0;-0,7 um\n50;1,8 um\n100;1,3 um\n"),
              AllOf(StartsWith("refused: s.csv:2: \"-0,7 um\": the cells of \"Abweichung\" have a unit"),
                    HasSubstr("write the unit in the heading ([um])")));
}

TEST(SheetRemarks, DegreesMinutesAndSecondsByTheHeading) {
  EXPECT_THAT(
      read("C Soll [\u00b0 ' \"];C Ist [\u00b0 ' \"]\n0 00 00;0 00 02\n30 00 00;30 30 00\n60 00 00;60 00 "
           "04,5\n"),
      StartsWith("C[deg],rz[deg]\n0,0.000555556\n30,30.5\n60,60.00125\n"));
}

TEST(SheetRemarks, TwoReadingsOfAnAxisAreNamedByTheirHeadings) {
  EXPECT_THAT(
      read("X [mm];Abweichung X [um];Fehler X [um]\n0;1;2\n50;2;5\n100;3;9\n"),
      AllOf(StartsWith("refused: s.csv:1: \"Fehler X [um]\": this column and the column \"Abweichung X "
                       "[um]\" both have the meaning x"),
            HasSubstr("--leave \"Abweichung X [um]\" or --leave \"Fehler X [um]\"")));
}

TEST(SheetRemarks, VerdictsAreNoMeasurement) {
  const auto rows = [](const std::string& heading, const std::string& good, const std::string& bad) {
    return "X [mm];dX [um];" + heading + "\n0;1;" + good + "\n50;2;" + bad + "\n100;3;" + good + "\n";
  };
  const std::string read_as = "X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.003\nnote: the column \"";
  for (const char* const heading : {"OK?", "i.O.", "n.i.O.", "Pass/Fail", "Bewertung", "i.O./n.i.O.", "OK"}) {
    EXPECT_THAT(read(rows(heading, "1", "0")), StartsWith(read_as + heading + "\" has a verdict")) << heading;
    EXPECT_THAT(read(rows(heading, "", "x")), StartsWith(read_as + heading + "\" has a verdict")) << heading;
  }
  EXPECT_THAT(read(rows("Pass", "Pass", "Fail")), StartsWith(read_as + "Pass\" has a verdict"));
  EXPECT_THAT(read(rows("Ergebnis", "i.O.", "n. i. O.")), StartsWith(read_as + "Ergebnis\" has a verdict"));
  EXPECT_THAT(read(rows("Remark", "", "1")), StartsWith(read_as + "Remark\" has remarks"));
  // Words of a state, remarks in words and numbers of a run are labels.
  EXPECT_THAT(read(rows("Status", "kalt", "warm")), StartsWith("X[mm],x[mm],Status\n0,0.001,kalt\n"));
  EXPECT_THAT(read(rows("Remark", "", "slow")), StartsWith("X[mm],x[mm],Remark\n"));
  EXPECT_THAT(read(rows("Pass", "1", "2")), StartsWith("X[mm],x[mm],run\n"));
  SheetWords words;
  words.columns = {"label=OK?"};
  EXPECT_THAT(read(rows("OK?", "ja", "nein"), words), StartsWith("X[mm],x[mm],label\n0,0.001,ja\n"));
}

TEST(SheetRemarks, VerdictsBesideRuns) {
  EXPECT_THAT(read("X [mm];Lauf 1 [um];n.i.O.;Lauf 2 [um];OK?\n0;1;;2;1\n50;2;x;3;0\n100;3;;4;1\n"),
              StartsWith("X[mm],run,x[mm]\n0,1,0.001\n50,1,50.002\n"));
  EXPECT_THAT(read("Achse X\nLauf 1 Pos [mm];Lauf 1 Abw [um];Lauf 2 Pos [mm];Lauf 2 Abw [um];OK?\n"
                   "0;1;10;2;ok\n50;2;60;3;ok\n100;3;110;4;n.i.O.\n"),
              StartsWith("X[mm],x[mm],run\n0,0.001,1\n50,50.002,1\n100,100.003,1\n10,10.002,2\n"));
  // A reading that is marked as invalid is no reading.
  EXPECT_THAT(read("X [mm];dX [um];Valid\n0;1;1\n50;2;0\n100;3;1\n"),
              StartsWith("X[mm],x[mm]\n0,0.001\n100,100.003\n"));
}

}  // namespace
}  // namespace vernier::sheet_remarks_test
