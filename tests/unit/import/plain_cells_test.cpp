// SPDX-License-Identifier: GPL-3.0-or-later
// Columns and cells whose text states what they are: roles, uncertainties, results, lengths between points.
#include "tools/import/reading/plain_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::plain_cells_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

TEST(PlainCells, RolesInOtherWordsAreRoles) {
  EXPECT_THAT(read("X [mm];x [mm];Verwendung\n0;0,001;Prüfung\n50;50,002;Anpassung\n90;90,001;Anpassung\n"),
              AllOf(StartsWith("X[mm],x[mm],role\n0,0.001,check\n50,50.002,fit\n90,90.001,fit\n"),
                    HasSubstr("note: \"Verwendung\" is the role of each row")));
  EXPECT_THAT(read("X [mm];x [mm];Rolle\n0;0,001;Prüfung\n50;50,002;Anpassung\n"),
              StartsWith("X[mm],x[mm],role\n0,0.001,check\n50,50.002,fit\n"));
  // A column with another word is a label.
  EXPECT_THAT(read("X [mm];x [mm];Verwendung\n0;0,001;Prüfung\n50;50,002;Halle 3\n"),
              StartsWith("X[mm],x[mm],Verwendung\n0,0.001,Prüfung\n"));
}

TEST(PlainCells, AnExpandedUncertaintyIsDividedByItsFactor) {
  EXPECT_THAT(read("X [mm];x [mm];U(k=2) [µm]\n0;0,001;10\n50;50,002;5\n"),
              AllOf(StartsWith("X[mm],x[mm],u[um]\n0,0.001,5\n50,50.002,2.5\n"),
                    HasSubstr("its values divided by 2 are the standard uncertainty u")));
  EXPECT_THAT(read("X [mm];x [mm];Messunsicherheit k = 2,5 [µm]\n0;0,001;10\n50;50,002;5\n"),
              StartsWith("X[mm],x[mm],u[um]\n0,0.001,4\n50,50.002,2\n"));
}

TEST(PlainCells, UncertaintiesOfCoordinatesAreNoInputs) {
  const std::string table = "X [mm];x [mm];Ux [mm];Uy [mm]\n0;0,001;0,005;0,006\n50;50,002;0,005;0,006\n";
  EXPECT_THAT(read(table), AllOf(StartsWith("X[mm],x[mm]\n"),
                                 HasSubstr("note: the columns \"Ux [mm]\", \"Uy [mm]\" are uncertainties")));
  SheetWords words;
  words.columns = {"u=Ux [mm]"};
  EXPECT_THAT(read(table, words), StartsWith("X[mm],x[mm],u[mm]\n0,0.001,0.005\n"));
}

TEST(PlainCells, TheValueBeforeAToleranceIsRead) {
  EXPECT_THAT(read("X [mm];Abw. X [µm]\n0;-3,7 ± 0,4\n50;0,1 ± 0,4\n100;3,0 ± 0,4\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,-0.0037\n50,50.0001\n100,100.003\n"),
                    HasSubstr("note: line 2: \"-3,7 ± 0,4\" and 2 more cells have a value and its")));
}

TEST(PlainCells, ResultsBesideTheTableAreNoAxes) {
  EXPECT_THAT(read("Soll X [mm];Abweichung X [µm];;A=;B=\n0;1;;22,4;6,1\n50;2;;;\n100;3;;;\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,0.001\n"),
                    HasSubstr("note: the columns \"A=\", \"B=\" have results beside the rows")));
}

TEST(PlainCells, ATitleAboutTheOrderOfTimeGetsANote) {
  const std::string table =
      "Pos [mm];hin 1 [µm];rück 1 [µm]\n0;-3,7;15,3\n50;0,1;13\n100;3;11,7\n150;5,3;10,5\n";
  EXPECT_THAT(
      read("Achse X\nrück: Messwerte in zeitlicher Reihenfolge (500 -> 0)\n" + table),
      HasSubstr("note: the title \"rück: Messwerte in zeitlicher Reihenfolge (500 -> 0)\" may state"));
  EXPECT_THAT(read("Achse X\nMaschine 7\n" + table), Not(HasSubstr("order of time")));
}

TEST(PlainCells, TheNumberOfARunIsTheRun) {
  EXPECT_THAT(read("Target X (mm),Deviation X (microns),Run #\n0.0,-3.7,1\n50.0,0.1,1\n0.0,-3.6,2\n"),
              StartsWith("X[mm],x[mm],run\n0.0,-0.0037,1\n"));
}

TEST(PlainCells, ItalianHeadingsAreRead) {
  EXPECT_THAT(read("Posizione nominale X [mm];Scostamento X [µm];Direzione;Corsa\n0,0;-3,7;andata;1\n"
                   "50,0;0,1;andata;1\n50,0;9,1;ritorno;1\n"),
              StartsWith("X[mm],x[mm],dirX,run\n0.0,-0.0037,1,1\n50.0,50.0001,1,1\n50.0,50.0091,-1,1\n"));
}

TEST(PlainCells, UnitsOfErrorsInATitleAreThoseOfTheDeviations) {
  EXPECT_THAT(read("Units: mm  Error units: micrometres\nAxis: X\nTarget\tError\n0.000\t-3.7\n50.000\t0.1\n"
                   "100.000\t3.0\n"),
              StartsWith("X[mm],x[mm]\n0.000,-0.0037\n"));
}

TEST(PlainCells, TheInchMarkOfARotaryAxisIsAnArcsecondInAnyUnitOfPositions) {
  EXPECT_THAT(read("C soll [gon];Abw C [\"]\n0,0000;0,0\n33,3333;1,5\n66,6667;2,6\n100,0000;3,0\n"),
              AllOf(HasSubstr("[gon] is no known unit"), Not(HasSubstr("38.1 mm"))));
}

TEST(PlainCells, APointOfARobotIsNamedByItsThreeColumns) {
  EXPECT_THAT(
      read("pose,joint_a1 [deg],joint_a2 [deg],joint_a3 [deg],Tx [mm],Ty [mm],Tz [mm]\n"
           "1,73.2,42.4,-6.1,1007.2,-785.6,1131.6\n2,19.8,25.6,-41.9,1490.9,-1400.2,1465.9\n"),
      HasSubstr("--column \"x=Tx [mm]\" --column \"y=Ty [mm]\" --column \"z=Tz [mm]\" (the point that"));
  // One length beside the joints: not a joint angle as a position.
  EXPECT_THAT(read("joint_a1 [deg],joint_a2 [deg],joint_a3 [deg],gauge [mm]\n1,2,3,4\n5,6,7,8\n"),
              HasSubstr("--column \"x=gauge [mm]\""));
}

}  // namespace
}  // namespace vernier::plain_cells_test
