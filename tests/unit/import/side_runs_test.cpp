// SPDX-License-Identifier: GPL-3.0-or-later
// Runs side by side, each with its own column of positions, in the forms that people write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::side_runs_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kTwoRuns =
    "X[mm],x[mm],run\n0,0.001,1\n50,50.002,1\n100,100.003,1\n10,10.002,2\n60,60.003,2\n110,110.004,2\n";

TEST(SideRuns, PositionsBeforeDeviations) {
  EXPECT_THAT(
      read("Axis: X\nPos Run 1 [mm],Pos Run 2 [mm],Dev Run 1 [um],Dev Run 2 [um]\n0,10,1,2\n50,60,2,3\n"
           "100,110,3,4\n"),
      StartsWith(kTwoRuns));
}

TEST(SideRuns, TheSameHeadingsAgain) {
  EXPECT_THAT(read("Achse: X\nPos [mm];Abw [um];Pos [mm];Abw [um]\n0;1;10;2\n50;2;60;3\n100;3;110;4\n"),
              StartsWith(kTwoRuns));
}

TEST(SideRuns, AMeanBesideTheRunsIsOmitted) {
  EXPECT_THAT(read("Axis: X\nRun 1 Pos [mm],Run 1 Dev [um],Run 2 Pos [mm],Run 2 Dev [um],Mean [um]\n"
                   "0,1,10,2,1.5\n50,2,60,3,2.5\n100,3,110,4,3.5\n"),
              AllOf(StartsWith(kTwoRuns), HasSubstr("the column \"Mean [um]\" is computed from the runs")));
}

TEST(SideRuns, RunsWithDirections) {
  const std::string rows =
      "X[mm],x[mm],dirX,run\n0,0.001,1,1\n50,50.002,1,1\n100,100.003,1,1\n100,100.004,-1,1\n50,50.003,-1,1\n"
      "0,0.002,-1,1\n";
  EXPECT_THAT(
      read("Achse: X\n1+ Pos [mm];1+ Abw [um];1- Pos [mm];1- Abw [um]\n0;1;100;4\n50;2;50;3\n100;3;0;2\n"),
      StartsWith(rows));
  EXPECT_THAT(read("Axe : X\nPassage 1 aller Pos (mm);Passage 1 aller Écart (um);Passage 1 retour Pos "
                   "(mm);Passage 1 retour Écart (um)\n0;1;100;4\n50;2;50;3\n100;3;0;2\n"),
              StartsWith(rows));
}

TEST(SideRuns, PositionsBesideADirectionAlone) {
  EXPECT_THAT(read("Achse X, Abweichungen\nPos [mm];hin [um];Pos [mm];rück [um]\n0;1;100;4\n50;2;50;3\n"
                   "100;3;0;2\n"),
              StartsWith("X[mm],x[mm],dirX\n0,0.001,1\n50,50.002,1\n100,100.003,1\n100,100.004,-1\n"));
}

TEST(SideRuns, OfDifferentUnitsAreConverted) {
  EXPECT_THAT(
      read("Axis: X\nRun 1 Pos [mm],Run 1 Dev [um],Run 2 Pos [in],Run 2 Dev [thou]\n0,1.0,0,0.1\n"
           "50,2.0,2,0.2\n100,3.0,4,0.1\n"),
      AllOf(
          StartsWith(
              "X[mm],x[mm],run\n0,0.001,1\n50,50.002,1\n100,100.003,1\n0,0.00254,2\n50.8,50.80508,2\n"),
          HasSubstr("note: the runs have several units: the values of \"Run 2 Dev [thou]\" are converted to "
                    "[um], the unit of \"Run 1 Dev [um]\"")));
  EXPECT_THAT(read("X [mm];Run 1 [um];Run 2 [mm]\n0;1,2;0,0017\n50;2,0;0,0030\n100;3,1;-0,0042\n"),
              AllOf(StartsWith("X[mm],run,x[mm]\n0,1,0.0012\n50,1,50.002\n100,1,100.0031\n0,2,0.0017\n50,2,"
                               "50.003\n100,2,99.9958\n"),
                    HasSubstr("the values of \"Run 2 [mm]\" are converted to [um]")));
  // A length and an angle have no common unit.
  EXPECT_THAT(read("X [mm];Run 1 [um];Run 2 [deg]\n0;1;2\n50;2;3\n100;3;4\n"), StartsWith("refused"));
}

TEST(SideRuns, AConvertedRunInTheWrongUnitIsRefused) {
  EXPECT_THAT(
      read("X [mm];Run 1 [um];Run 2 [mm]\n0;1,2;1,7\n50;2,0;3,0\n100;3,1;4,2\n150;3,5;4,4\n200;3,9;5\n"),
      AllOf(StartsWith("refused"), HasSubstr("Run 2")));
}

TEST(SideRuns, RemarksBelongToTheRowsOfAllRuns) {
  EXPECT_THAT(read("Achse X\nLauf 1 Pos [mm];Lauf 1 Abw [um];Lauf 2 Pos [mm];Lauf 2 Abw [um];Bemerkung\n"
                   "0;1;10;2;\n50;2;60;3;warm\n100;3;110;4;\n"),
              StartsWith("X[mm],x[mm],Bemerkung,run\n0,0.001,,1\n50,50.002,warm,1\n100,100.003,,1\n"
                         "10,10.002,,2\n60,60.003,warm,2\n"));
}

TEST(SideRuns, ARemedyDoesNotSetTheMeasuredAxis) {
  EXPECT_THAT(
      read("Pos links [mm];Abw links [um];Pos rechts [mm];Abw rechts [um]\n0;1;10;2\n50;2;60;3\n"),
      AllOf(StartsWith("refused"), HasSubstr("--column \"X=Pos links [mm]\""), Not(HasSubstr("--set"))));
}

TEST(SideRuns, AFrenchTableOfSeveralAxes) {
  EXPECT_THAT(read("Axe;Cible (mm);Écart (um)\nX;0;1\nX;50;2\nY;0;3\n"),
              AllOf(StartsWith("refused"), HasSubstr("the rows belong to the axes X, Y of this column")));
}

TEST(SideRuns, OfSeveralAxesInOneTable) {
  SheetWords words;
  words.constants = {"X[mm]=0", "Y[mm]=250"};
  EXPECT_THAT(read("Achse;Lauf 1 [um];Lauf 2 [um];Pos [mm]\nX;1;2;0\nX;2;3;50\nY;4;5;0\nY;6;7;50\n", words),
              StartsWith("X[mm],Y[mm],run,x[mm],y[mm]\n0,250,1,0.001,\n50,250,1,50.002,\n0,0,1,,0.004\n"));
  EXPECT_THAT(read("Achse;Lauf 1 [um];Lauf 2 [um]\nX;1;2\nX;2;3\nY;4;5\nY;6;7\n"),
              AllOf(StartsWith("refused"), Not(HasSubstr("--set \"X[mm]=0\""))));
}

}  // namespace
}  // namespace vernier::side_runs_test
