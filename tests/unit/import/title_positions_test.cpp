// SPDX-License-Identifier: GPL-3.0-or-later
// Titles that state where the axes stood that did not move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/reading/title_positions.h"

namespace vernier::title_positions_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kTable = "Pos [mm];Abw [um]\n0;1\n50;2\n100;3\n";

/// The positions of a title: "X=250mm Z=100"; a position that is not clear has a question mark.
std::string positions(const std::string& title, const SheetWishes& wishes = {}) {
  std::string text;
  for (const TitlePosition& one : positions_in_title(title, wishes))
    text += (text.empty() ? "" : " ") + one.axis + "=" + one.number + one.unit + (one.read ? "" : "?");
  return text;
}

TEST(TitlePositions, AreReadInTheUsualForms) {
  EXPECT_EQ(positions("Achse Y bei X=250 mm, Z = 100"), "X=250mm Z=100");
  EXPECT_EQ(positions("Y axis, X 250"), "X=250");
  EXPECT_EQ(positions("Y axis at X 250, Z -100.5 mm"), "X=250 Z=-100.5mm");
  EXPECT_EQ(positions("X-Achse fest auf 250 mm"), "X=250mm");
  EXPECT_EQ(positions("Position X: 250,5 mm"), "X=250,5mm");
  EXPECT_EQ(positions("X [mm] = 250"), "");
  EXPECT_EQ(positions("X = 250 [mm] und C = 90°"), "X=250mm C=90deg");
  EXPECT_EQ(positions("X=250 C=90 deg"), "X=250 C=90deg");
  EXPECT_EQ(positions("Achse X bei C 90"), "C=90");
}

TEST(TitlePositions, OtherNumbersAreNoPositions) {
  for (const char* const title : {"X 0 bis 500 mm",
                                  "X = 0 - 500 mm",
                                  "X=0, 100, 200 mm",
                                  "X 0..500",
                                  "Verfahrweg X=500 mm, Y=400 mm",
                                  "Maschine X 250",
                                  "Hermle C 42, Achse X",
                                  "Achse X, 3 Läufe",
                                  "Achse X: 11 Punkte",
                                  "A = 12,3",
                                  "B = 3 µm",
                                  "U = 2 µm (k=2)",
                                  "X bei 20 °C",
                                  "X at 20 C",
                                  "Toleranz X = 0,01 mm",
                                  "Y2-Achse",
                                  "X1",
                                  "Abweichung X = Ist - Soll",
                                  "X x Y = 500 x 400",
                                  "X: 3. Lauf"})
    EXPECT_EQ(positions(title), "") << title;
  EXPECT_EQ(positions("Nullpunkt G54: X=312,5"), "X=312,5?");
}

TEST(TitlePositions, BecomeConstants) {
  const std::string note =
      "note: the title \"Achse Y bei X=250 mm, Z = 100\" states the position X = 250 mm: each row gets this "
      "position; if it is wrong, give the right one with --set \"X[mm]=POSITION\"";
  EXPECT_THAT(read("Achse Y bei X=250 mm, Z = 100\n" + kTable),
              AllOf(StartsWith("Y[mm],y[mm],X[mm],Z[mm]\n0,0.001,250,100\n"), HasSubstr(note)));
  EXPECT_THAT(read("Y axis, X 250\n\n" + kTable), StartsWith("Y[mm],y[mm],X[mm]\n0,0.001,250\n"));
  EXPECT_THAT(read("# Achse Y bei X=250,5 mm\nY [mm];dY [um]\n0;1\n50;2\n"),
              StartsWith("Y[mm],y[mm],X[mm]\n0,0.001,250.5\n"));
  // In cells of their own.
  EXPECT_THAT(read("Achse;Y\nX =;250 mm\n" + kTable), StartsWith("Y[mm],y[mm],X[mm]\n0,0.001,250\n"));
}

TEST(TitlePositions, AnOptionAndAColumnHavePriority) {
  SheetWords words;
  words.constants = {"X[mm]=300"};
  EXPECT_THAT(read("Achse Y bei X=250 mm\n" + kTable, words),
              AllOf(StartsWith("Y[mm],y[mm],X[mm]\n0,0.001,300\n"), Not(HasSubstr("states"))));
  EXPECT_THAT(read("Start: X=0, Y=100\nX [mm];dX [um]\n0;1\n50;2\n"),
              StartsWith("X[mm],x[mm],Y[mm]\n0,0.001,100\n"));
}

TEST(TitlePositions, TheStraightnessOfAnAxisThatStandsStill) {
  EXPECT_THAT(read("Achse Y bei X=250 mm\nPos [mm];dX [um]\n0;1\n50;2\n100;3\n"),
              StartsWith("Y[mm],x[mm],X[mm]\n0,250.001,250\n"));
}

TEST(TitlePositions, ContradictionsAreRefused) {
  EXPECT_THAT(read("Achse Y bei X=250 mm\nX = 300 mm\n" + kTable),
              AllOf(StartsWith("refused: s.csv:2: \"X = 300 mm\": the title \"Achse Y bei X=250 mm\" states "
                               "another position of X"),
                    HasSubstr("--set \"X[mm]=0\"")));
  EXPECT_THAT(
      read("Achse Y bei X=250 mm\nX [mm];dX [um]\n0;1\n50;2\n100;3\n"),
      AllOf(StartsWith("refused: s.csv:2: \"Achse Y bei X=250 mm\": this title states the axis Y, and "
                       "the headings have the positions of X"),
            HasSubstr("--column \"Y=X [mm]\" --deviation \"Y=dX [um]\"")));
}

TEST(TitlePositions, UnclearNumbersGetANote) {
  EXPECT_THAT(read("Achse Y, Nullpunkt X=250 mm\n" + kTable),
              AllOf(StartsWith("Y[mm],y[mm]\n"),
                    HasSubstr("has a number beside the axis X, which is not read as its position; if X stood "
                              "there, give --set \"X[mm]=250\"")));
  SheetWords words;
  words.table = 2;
  EXPECT_THAT(read("Achse Y bei X=250\n" + kTable + "Achse Y\n" + kTable, words),
              AllOf(StartsWith("Y[mm],y[mm]\n"), HasSubstr("give --set \"X[mm]=250\"")));
}

TEST(TitlePositions, AProfileDoesNotStoreThem) {
  const SheetReading reading = read_as_sheet("Achse Y bei X=250 mm\n" + kTable, "s.csv", {});
  EXPECT_THAT(sheet_profile(reading.sheet, reading.table, reading.columns, reading.wishes),
              Not(HasSubstr("set X")));
}

}  // namespace
}  // namespace vernier::title_positions_test
