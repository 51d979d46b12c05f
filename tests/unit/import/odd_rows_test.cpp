// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and cells that workshops write into a table, and columns of signs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::odd_rows_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

TEST(OddRows, RepeatedHeadingsOfAPageAreNoSecondTable) {
  const std::string page = "X [mm];Abw. X [µm]\n0;-3,2\n50;-0,6\n";
  const std::string rows = "X[mm],x[mm]\n0,-0.0032\n50,49.9994\n100,100.0013\n150,150.0024\nnote";
  for (const std::string between : {"\nSeite 2 von 2\n", "Page 2/2\n", "\nFortsetzung\n"})
    EXPECT_THAT(read(page + between + "X [mm];Abw. X [µm]\n100;1,3\n150;2,4\n"),
                AllOf(StartsWith(rows), HasSubstr("the headings are repeated on further pages")))
        << between;
  for (const std::string between : {"\nLauf 2\n", "\n", "\nSeite 2\nY = 250 mm\n"})
    EXPECT_THAT(read(page + between + "X [mm];Abw. X [µm]\n100;1,3\n150;2,4\n"),
                HasSubstr("the file has 2 tables"))
        << between;
  EXPECT_THAT(read(page + "\nSeite 2\nX [mm];Abw. X [mm]\n100;1,3\n150;2,4\n"),
              HasSubstr("the file has 2 tables"));
}

TEST(OddRows, ALineAboutTheStateIsOmitted) {
  EXPECT_THAT(read("X [mm];Abw. X [µm]\n0;-3,2\nTemp. Maschine;20,4\n50;-0,6\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,-0.0032\n50,49.9994\n"),
                    HasSubstr("line 3: \"Temp. Maschine 20,4\" is a line about the state")));
  EXPECT_THAT(read("X [mm];Abw. X [µm]\n0;-3,2\nHuber;20,4\n50;-0,6\n"),
              HasSubstr("not a number, for X; correct the number, or delete the row"));
}

TEST(OddRows, AFailedFormulaIsACellWithoutAValue) {
  EXPECT_THAT(read("X [mm];Abw. X [µm]\n0;-3,2\n50;#BEZUG!\n100;#DIV/0!\n150;1\n"),
              AllOf(StartsWith("X[mm],x[mm]\n0,-0.0032\n50,\n100,\n150,150.001\n"),
                    HasSubstr("line 3: \"#BEZUG!\" is a failed formula")));
}

TEST(OddRows, ARemarkAboutARepetitionNamesBothRows) {
  EXPECT_THAT(
      read("X [mm];Abw. X [µm];Bem.\n0;1;\n50;2;\n100;3;\n50;7;Nachmessung\n"),
      HasSubstr(
          "line 5: the remark \"Nachmessung\", and line 3 has the same position 50: both rows are read"));
  EXPECT_THAT(read("X [mm];Abw. X [µm];Bem.\n0;1;\n50;2;\n100;3;Nachmessung\n"),
              Not(HasSubstr("same position")));
}

TEST(OddSigns, OfAColumnOfTheirOwnAreApplied) {
  const std::string text = read("X [mm];VZ;Abw. X [µm]\n0;-;3,2\n50;−;0,6\n100;+;1,3\n");
  EXPECT_THAT(text, AllOf(StartsWith("X[mm],x[mm]\n0,-0.0032\n50,49.9994\n100,100.0013\n"),
                          HasSubstr("\"VZ\" has the signs"), Not(HasSubstr("approach directions"))));
  EXPECT_THAT(read("X [mm];VZ;Abw. X [µm]\n0;-;-3,2\n50;-;0,6\n100;+;1,3\n"),
              HasSubstr("but this value has a sign of its own"));
  EXPECT_THAT(read("X [mm];VZ;Abw. X [µm]\n0;-;3,2\n50;;0,6\n100;+;1,3\n"),
              HasSubstr("but this row has no sign"));
}

TEST(OddSigns, LostInOneRunAreNoted) {
  const auto table = [](const std::string& third) {
    return read("X [mm];Lauf 1 [µm];Lauf 2 [µm]\n0;-11,2;11,6\n50;-8,6;8,5\n100;-6,7;" + third +
                "\n150;-5,6;5,7\n200;1,4;1,5\n");
  };
  EXPECT_THAT(table("6,7"), HasSubstr("\"Lauf 2 [µm]\" has no negative value"));
  EXPECT_THAT(read("X [mm];1+ [µm];1- [µm]\n0;11,6;-11,2\n50;8,5;-8,6\n100;6,7;-6,7\n150;5,7;-5,6\n"),
              Not(HasSubstr("has no negative value")))
      << "the directions may have opposite values";
  EXPECT_THAT(table("-6,7"), Not(HasSubstr("has no negative value")));
  EXPECT_THAT(read("X [mm];1+ [µm];1- [µm]\n0;-1;4\n50;-2;5\n100;-3;6\n150;-1;4\n"),
              Not(HasSubstr("has no negative value")));
}

TEST(OddHeadings, TheSecondsOfARotaryAxisAreArcseconds) {
  EXPECT_THAT(read("C [°];Abw. C [\"]\n0;-3,6\n36;-1,8\n72;1,8\n108;3,6\n"),
              StartsWith("C[deg],rz[deg]\n0,-0.001\n36,35.9995\n72,72.0005\n108,108.001\n"));
  SheetWords words;
  words.deviations = {"C[arcsec]=Abw. C [\"]"};
  EXPECT_THAT(read("C [°];Abw. C [\"]\n0;-3,6\n36;-1,8\n72;1,8\n", words),
              StartsWith("C[deg],rz[deg]\n0,-0.001\n"));
}

TEST(OddHeadings, ACountBesideThePositionsIsNoPosition) {
  EXPECT_THAT(read("Pos.;Weg X [mm];Abw. [µm]\n1;0;-3,2\n2;50;-0,6\n3;100;1,3\n"),
              StartsWith("Pos,X[mm],x[mm]\n1,0,-0.0032\n2,50,49.9994\n"));
}

TEST(OddHeadings, TheRemedyForPositionsNamesNoCount) {
  EXPECT_THAT(read("Pos.;Strecke [mm];Abw. [µm]\n1;0;-3,2\n2;50;-0,6\n3;100;1,3\n"),
              HasSubstr("--deviation \"X=Abw. [µm]\" --column \"X=Strecke [mm]\""));
}

TEST(OddHeadings, ThePointOfARobotIsProposed) {
  const std::string rows =
      "Pose,Base,Shoulder,Elbow,X [mm],Y [mm],Z [mm]\n1,10,20,30,100,200,300\n"
      "2,15,25,31,110,220,320\n3,16,22,33,120,210,310\n";
  EXPECT_THAT(read(rows), HasSubstr("--column \"x=X [mm]\" --column \"y=Y [mm]\" --column \"z=Z [mm]\""));
}

}  // namespace
}  // namespace vernier::odd_rows_test
