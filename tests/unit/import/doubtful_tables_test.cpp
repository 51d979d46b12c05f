// SPDX-License-Identifier: GPL-3.0-or-later
// Tables whose axis, decimal sign, unit or direction the cells do not state clearly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/import/table_reading.h"
#include "tools/sheet/workbook_writer.h"

namespace vernier::doubtful_tables_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

std::string book(const std::string& name, const std::vector<std::string>& headings) {
  sheet::SheetToWrite one;
  one.name = name;
  one.rows = {headings, {"0", "1"}, {"50", "2"}, {"100", "3"}};
  return sheet::workbook_of({one});
}

TEST(AxisOfTheSheet, IsThatOfItsName) {
  for (const char* const name : {"Y", "Y-Achse", "Achse Y", "Laser Y"})
    EXPECT_THAT(read(book(name, {"Soll [mm]", "Abweichung [um]"})),
                AllOf(StartsWith("Y[mm],y[mm]\n0,0.001\n50,50.002\n"), HasSubstr("states this axis")))
        << name;
  EXPECT_THAT(read(book("Tabelle1", {"Soll [mm]", "Abweichung [um]"})), HasSubstr("X=Soll [mm]"));
  EXPECT_THAT(read(book("A", {"Soll [mm]", "Abweichung [um]"})), HasSubstr("X=Soll [mm]"));
}

TEST(AxisOfTheSheet, IsNotThatOfTheHeadings) {
  EXPECT_THAT(read(book("Y", {"Soll X [mm]", "Abweichung X [um]"})),
              AllOf(StartsWith("refused: "), HasSubstr("this name of the sheet states the axis Y, and the "
                                                       "headings have the positions of X")));
  EXPECT_THAT(read(book("X", {"Soll X [mm]", "Abweichung X [um]"})),
              AllOf(StartsWith("X[mm],x[mm]\n"), Not(HasSubstr("note"))));
  // Straightness of X in the direction Y.
  EXPECT_THAT(read(book("Y", {"Soll X [mm]", "Abweichung Y [um]"})), Not(HasSubstr("name of the sheet")));
  SheetWords words;
  words.columns = {"X=Soll [mm]"};
  words.deviations = {"X=Abweichung [um]"};
  EXPECT_THAT(read(book("Y", {"Soll [mm]", "Abweichung [um]"}), words),
              AllOf(StartsWith("X[mm],x[mm]\n"), HasSubstr("the columns are assigned to X: check the axis")));
}

TEST(Thousands, TargetsThatNoCellDecidesAreRefused) {
  const std::string whole = "Soll X [mm];Abweichung X [um]\n1.000;0\n2.000;3\n3.000;-2\n";
  EXPECT_THAT(read(whole), HasSubstr("can be 1 or 1000: no cell of the table shows whether the point is the "
                                     "decimal sign or separates thousands"));
  SheetWords words;
  words.decimal = "comma";
  EXPECT_THAT(read(whole, words), StartsWith("X[mm],x[mm]\n1000,1000\n2000,2000.003\n"));
  words.decimal = "point";
  EXPECT_THAT(read(whole, words), StartsWith("X[mm],x[mm]\n1.000,1\n2.000,2.003\n"));
  // 100 m are no travel, and readings with as many decimals decide.
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um]\n100.000;0\n200.000;3\n300.000;-2\n"),
              StartsWith("X[mm],x[mm]\n100.000,100\n"));
  EXPECT_THAT(read("X [mm];x [mm]\n1.000;1.002\n2.000;2.003\n3.000;3.001\n"),
              StartsWith("X[mm],x[mm]\n1.000,1.002\n"));
}

TEST(Directions, ASingleRowOfTheOtherDirectionIsRefused) {
  EXPECT_THAT(
      read("Soll X [mm];Richtung;Abw X [um]\n0;+;0\n50;+;3\n100;-;1\n150;+;4\n200;+;7\n250;+;11\n"),
      AllOf(StartsWith("refused: s.csv:4: \"Richtung\": the direction in line 4 differs from the rows "
                       "above and below"),
            HasSubstr("--column \"dirX=Richtung\"")));
  // A table that is sorted by its positions.
  EXPECT_THAT(read("Soll X [mm];Richtung;Abw X [um]\n0;+;0\n0;-;3\n50;-;1\n50;+;4\n100;+;7\n100;-;11\n"),
              StartsWith("X[mm],dirX,x[mm]\n"));
  EXPECT_THAT(read("Soll X [mm];Richtung;Abw X [um]\n0;Vorw\u00e4rts;0\n50;Vorw\u00e4rts;3\n"
                   "50;R\u00dcCKW\u00c4RTS;4\n0;R\u00dcCKW\u00c4RTS;1\n"),
              StartsWith("X[mm],dirX,x[mm]\n0,1,0\n50,1,50.003\n50,-1,50.004\n"));
}

TEST(Symbols, OfIso230) {
  EXPECT_THAT(read("i;Pi [mm];xi [um]\n1;0;0\n2;50;3\n3;100;1\n"),
              AllOf(StartsWith("refused: "), HasSubstr("--column \"X=Pi [mm]\""), Not(HasSubstr("x=Pi"))));
  EXPECT_THAT(read("Soll [mm];1+ [um];1- [um];x_\u0304 [um]\n0;0;2;1\n50;3;5;4\n100;1;3;2\n"),
              AllOf(StartsWith("refused: "), Not(HasSubstr("x_\u0304"))));
}

}  // namespace
}  // namespace vernier::doubtful_tables_test
