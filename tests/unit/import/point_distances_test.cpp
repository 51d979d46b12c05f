// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of distances between named points: a printed square and a calliper.
#include "tools/import/distances/distance_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/distances/pair_names.h"
#include "tools/import/logs/point_positions.h"
#include "tools/model/machine_reader.h"
#include "tools/sheet/workbook_writer.h"

namespace vernier::point_distances_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::vector<std::string> kCorners = {"A=30,30,0.2", "B=200,30,0.2", "C=200,200,0.2", "D=30,200,0.2"};

SheetWords with(const std::vector<std::string>& points, const std::vector<std::string>& constants = {}) {
  SheetWords words;
  words.constants = constants;
  words.points = stated_points(points, constants, nullptr);
  return words;
}

SheetWords square() { return with(kCorners); }

const std::string kRows = "AB;170,00;170,12\nBC;170,00;169,93\nAC;240,42;240,28\nBD;240,42;240,57\n";

/// The rows of the square that all forms of the table above must give.
const std::string kSquare =
    "point,X[mm],Y[mm],Z[mm],distance[mm],from\nA,30,30,0.2,,\nB,200,30,0.2,,\nC,200,200,0.2,,\n"
    "D,30,200,0.2,,\nA-B,200,30,0.2,170.12,A\nB-C,200,200,0.2,169.93,B\nA-C,200,200,0.2,240.28,A\n"
    "B-D,30,200,0.2,240.57,B\n";

TEST(PointDistances, APairIsNamedInTheUsualForms) {
  using Pair = std::optional<PointPair>;
  for (const char* cell :
       {"AB", "A-B", "A \u2013 B", "A\u2013B", "A B", "A->B", "A \u2192 B", "A/B", "A nach B", "A to B",
        "|AB|", "AB:", "Seite AB", "Strecke A-B", "AB (unten)", "A\u0305B\u0305"})
    EXPECT_EQ(two_points(cell, {}, false), Pair({"A", "B"})) << cell;
  EXPECT_EQ(two_points("P1-P2", {}, false), Pair({"P1", "P2"}));
  EXPECT_EQ(two_points("P1P2", {}, false), Pair({"P1", "P2"}));
  EXPECT_EQ(two_points("P1P12", {}, false), Pair({"P1", "P12"}));
  EXPECT_EQ(two_points("VL-HR", {}, false), Pair({"VL", "HR"}));
  EXPECT_EQ(two_points("1-2", {}, false), Pair({"1", "2"}));
  // A heading or stated names decide what a word alone does not.
  EXPECT_EQ(two_points("12", {}, true), Pair({"1", "2"}));
  EXPECT_EQ(two_points("12", {}, false), std::nullopt);
  EXPECT_EQ(two_points("VLHR", {}, true), Pair({"VL", "HR"}));
  EXPECT_EQ(two_points("vorne links - hinten rechts", {}, true), Pair({"vorne links", "hinten rechts"}));
  EXPECT_EQ(two_points("ab", {"A", "B"}, true), Pair({"A", "B"}));
  EXPECT_EQ(two_points("112", {"1", "12", "11", "2"}, true), std::nullopt) << "two meanings";
  for (const char* cell : {"XY", "OK", "AA", "A", "2024-05", "Lauf 1", "170,12", "", "A-", "hin", "vor-rück"})
    EXPECT_EQ(two_points(cell, {}, false), std::nullopt) << cell;
}

TEST(PointDistances, TheRowsOfAPrintedSquareAreRead) {
  EXPECT_THAT(
      read("Strecke;Soll;Ist\n" + kRows, square()),
      AllOf(StartsWith(kSquare), HasSubstr("in mm they agree with the distances of the stated points"),
            HasSubstr("note: 4 measured distances between 4 points: a row for each")));
}

TEST(PointDistances, HeadingsUnitsTitlesAndSignsOfATableDoNotMatter) {
  const std::string point_rows =
      "A-B,170.00,170.12\nB-C,170.00,169.93\nA-C,240.42,240.28\nB-D,240.42,240.57\n";
  for (const std::string& table : std::vector<std::string>{
           "Strecke;Soll [mm];Ist [mm]\n" + kRows,
           "Messprotokoll Quadrat 170 mm\n\nSeite;Nennma\u00df;Istma\u00df\n;mm;mm\n" + kRows,
           "\xEF\xBB\xBFpair,nominal [mm],measured [mm]\n" + point_rows,
           "Side,Nominal,Actual\n" + point_rows,
           "from-to\tcaliper (mm)\nA->B\t170.12\nB->C\t169.93\nA->C\t240.28\nB->D\t240.57\n",
           std::string("von;nach;Soll;Ist\nA;B;170,00;170,12\nB;C;170,00;169,93\nA;C;240,42;240,28\n"
                       "B;D;240,42;240,57\n"),
           std::string("Punkt 1;Punkt 2;Abstand [mm]\nA;B;170,12\nB;C;169,93\nA;C;240,28\nB;D;240,57\n"),
           std::string("Nr;Diagonale;Soll;Ist\n1;A \u2013 B;170,00;170,12\n2;B \u2013 C;170,00;169,93\n\n"
                       "3;A \u2013 C;240,42;240,28\n4;B \u2013 D;240,42;240,57\n"),
           std::string("Strecke;Soll [cm];Ist [cm]\nAB;17;17,012\nBC;17;16,993\nAC;24,042;24,028\n"
                       "BD;24,042;24,057\n"),
           std::string("AB = 170.12 +- 0.02 mm\nBC = 169.93 +- 0.02 mm\nAC = 240.28 +- 0.02 mm\nBD = "
                       "240.57±0.02 mm\n"),
           std::string("AB 170.12 mm\nBC 169.93 mm\nAC 240.28 mm\nBD 240.57 mm\n"),
           std::string("AB = 170.12 mm\nBC = 169.93 mm\nAC = 240.28 mm\nBD = 240.57 mm\n"),
           std::string("Quadrat, PLA\n\nAB: 170,12\nBC: 169,93\nAC: 240,28\nBD: 240,57\n"),
           std::string("Strecke;Ist\nAB;170,12 mm\nBC;169,93 mm\nAC;240,28 mm\nBD;240,57 mm\n"),
           std::string("Strecke;Soll;Abweichung\nAB;170,00;0,12\nBC;170,00;-0,07\nAC;240,42;-0,14\n"
                       "BD;240,42;0,15\n"),
           std::string("AB;BC;AC;BD\n170,12;169,93;240,28;240,57\n"),
           std::string(";AB;BC;AC;BD\nSoll;170;170;240,42;240,42\nIst;170,12;169,93;240,28;240,57\n"),
           std::string("AB 170.12\nBC 169.93\nAC 240.28\nBD 240.57\n"),
       }) {
    SheetWords words = square();
    words.unit = table.find("Abweichung") != std::string::npos ? "mm" : "";
    EXPECT_THAT(read(table, words), StartsWith(kSquare)) << table;
  }
}

TEST(PointDistances, AWorkbookIsReadAsATextIs) {
  EXPECT_THAT(read(sheet::workbook_of({{"Quadrat",
                                        {{"Strecke", "Soll", "Ist"},
                                         {"AB", "170", "170.12"},
                                         {"BC", "170", "169.93"},
                                         {"AC", "240.42", "240.28"},
                                         {"BD", "240.42", "240.57"}}}}),
                   square()),
              StartsWith(kSquare));
}

TEST(PointDistances, RepeatedMeasurementsAreRows) {
  const std::string wanted =
      "A-B,200,30,0.2,170.12,A\nA-B,200,30,0.2,170.14,A\nA-C,200,200,0.2,240.28,A\n"
      "A-C,200,200,0.2,240.3,A\n";
  const SheetWords words = with({"A=30,30,0.2", "B=200,30,0.2", "C=200,200,0.2"});
  for (const char* table :
       {"Strecke;Soll;Ist 1;Ist 2;Mittel\nAB;170;170,12;170,14;170,13\nAC;240,42;240,28;240,30;240,29\n",
        "Strecke;Messung\nAB;170,12\nAB;170,14\nAC;240,28\nAC;240,30\n",
        "Strecke;Messung\nAB;170,12\n;170,14\nAC;240,28\n;240,30\n"})
    EXPECT_THAT(read(table, words), AllOf(HasSubstr(wanted), HasSubstr("2 of them repeated"))) << table;
  // Two numbers of a line without headings may also be the nominal and the measured distance.
  const char* const lines = "Quadrat\nAB: 170,12 170,14\nAC: 240,28 / 240,30\n";
  EXPECT_THAT(read(lines, words), HasSubstr("the columns have no headings"));
  SheetWords stated = words;
  stated.columns = {"distance[mm]=2", "distance[mm]=3"};
  EXPECT_THAT(read(lines, stated), HasSubstr(wanted));
  // A mean is the measured distance if the table has nothing else.
  EXPECT_THAT(read("Strecke;Soll;Mittelwert\nAB;170;170,13\nAC;240,42;240,29\n", words),
              HasSubstr("A-B,200,30,0.2,170.13,A\nA-C,200,200,0.2,240.29,A\n"));
}

TEST(PointDistances, PointsWithNumbersGetALetter) {
  const SheetWords words = with({"1=30,30,0.2", "2=200,30,0.2", "3=200,200,0.2"});
  const std::string wanted =
      "P1,30,30,0.2,,\nP2,200,30,0.2,,\nP3,200,200,0.2,,\nP1-P2,200,30,0.2,170.12,P1\n";
  for (const char* table :
       {"Strecke;Ist [mm]\n1-2;170,12\n1-3;240,28\n", "von;nach;Ist [mm]\n1;2;170,12\n1;3;240,28\n",
        "Strecke;Ist [mm]\n12;170,12\n13;240,28\n"})
    EXPECT_THAT(read(table, words), HasSubstr(wanted)) << table;
}

TEST(PointDistances, UncertaintiesAndLabelsStayWithTheirRows) {
  EXPECT_THAT(
      read("Strecke;Soll [mm];Ist [mm];u [mm];Bemerkung\nAB;170;170,12;0,03;links\nAC;240,42;240,28;0,05;\n",
           with({"A=30,30,0.2", "B=200,30,0.2", "C=200,200,0.2"})),
      AllOf(StartsWith("point,X[mm],Y[mm],Z[mm],distance[mm],from,u[mm],Bemerkung\nA,30,30,0.2,,,0.03,\n"),
            HasSubstr("A-B,200,30,0.2,170.12,A,0.03,links\nA-C,200,200,0.2,240.28,A,0.05,\n")));
  EXPECT_THAT(read("Strecke;Soll;Ist\n" + kRows, with(kCorners, {"u[mm]=0,02", "setup=print1"})),
              HasSubstr("A-B,200,30,0.2,170.12,A,0.02,print1\n"));
  // An axis that all points share.
  EXPECT_THAT(read("Strecke;Soll;Ist\n" + kRows,
                   with({"A=30,30", "B=200,30", "C=200,200", "D=30,200"}, {"Z[mm]=0.2"})),
              HasSubstr("from,Z[mm]\nA,30,30,,,0.2\n"));
}

TEST(PointDistances, WithoutPositionsOneMessageAsksForThem) {
  const std::string said = read("Strecke;Soll;Ist\n" + kRows);
  EXPECT_THAT(said,
              HasSubstr("refused: s.csv:1: \"A, B, C, D\": the rows are distances between named points"));
  EXPECT_THAT(said,
              HasSubstr("--point \"A=X,Y,Z\" --point \"B=X,Y,Z\" --point \"C=X,Y,Z\" --point \"D=X,Y,Z\""));
  EXPECT_THAT(said, Not(HasSubstr("--column")));
  EXPECT_THAT(read("Strecke;Soll;Ist\n" + kRows, with({"A=30,30,0.2", "B=200,30,0.2", "C=200,200,0.2"})),
              AllOf(HasSubstr("refused: s.csv:1: \"D\""), HasSubstr("give --point \"D=X,Y,Z\""),
                    Not(HasSubstr("\"A=X"))));
}

TEST(PointDistances, ExchangedCornersAreRefusedWithBothNumbers) {
  EXPECT_THAT(
      read("Strecke;Soll;Ist\n" + kRows,
           with({"A=30,30,0.2", "B=200,30,0.2", "D=200,200,0.2", "C=30,200,0.2"})),
      AllOf(HasSubstr("s.csv:3: \"170,00\": the nominal distance of B and C is 170 mm, and the stated points "
                      "are 240.416 mm apart (permitted difference: 0.5 mm, --tolerance)"),
            HasSubstr("if the positions of A and B, or of C and D are exchanged, all distances agree; only "
                      "one of these is right")));
  // Without nominal values the measured ones are compared.
  EXPECT_THAT(
      read("Strecke;Ist [mm]\nAB;170,12\nBC;169,93\nAC;240,28\n",
           with({"A=30,30,0.2", "C=200,30,0.2", "B=200,200,0.2"})),
      AllOf(HasSubstr("the measured distance of A and B is 170.12 mm"), HasSubstr("B and C are exchanged")));
  // A rounded drawing agrees; a drawing of another square only with a larger tolerance.
  EXPECT_THAT(read("Strecke;Soll;Ist\nAC;240;240,28\nBD;240;240,57\n", square()), StartsWith("point,"));
  SheetWords wide = square();
  EXPECT_THAT(read("Strecke;Soll;Ist\nAC;239;240,28\nBD;239;240,57\n", wide), HasSubstr("refused"));
  wide.points.tolerance_mm = 2;
  EXPECT_THAT(read("Strecke;Soll;Ist\nAC;239;240,28\nBD;239;240,57\n", wide), StartsWith("point,"));
  EXPECT_THAT(
      read("Strecke;Soll;Ist\nAC;141,42;141,28\nBD;141,42;141,57\n", square()),
      HasSubstr(
          "s.csv:2: \"141,42\": the distances have no unit, and in no usual unit they agree with the "
          "stated points: the distance of A and C is 141.42 here, and the stated points are 240.416 mm"));
  // A digit that was lost.
  EXPECT_THAT(read("Strecke;Soll;Ist\nAC;240,42;240,28\nBD;240,42;24,057\n", square()),
              HasSubstr("s.csv:3: \"24,057\": the measured distance of B and D is 24.057 mm"));
}

TEST(PointDistances, WhatIsUnclearIsRefusedWithItsRemedy) {
  EXPECT_THAT(
      read("Strecke;Soll;Ist\n" + kRows,
           with({"A=1,1,0", "B=171,1,0", "C=171,171,0", "D=1,171,0", "E=5,5,0"})),
      HasSubstr("\"E\": no row of the table has a distance to this point (points of the table: A, B, C, D)"));
  EXPECT_THAT(read("Strecke;Soll;Ist\n" + kRows, with({"A=1,1,0", "B=171,1,0", "C=171,171,0", "D=1,1,0"})),
              HasSubstr("\"D\": this point and the point A have the same position"));
  EXPECT_THAT(read("Strecke;vorher [mm];nachher [mm]\nAC;240,28;240,40\nBD;240,57;240,43\n", square()),
              AllOf(HasSubstr("\"vorher [mm]\", \"nachher [mm]\" may all have the measured distances"),
                    HasSubstr("--leave \"nachher [mm]\"")));
  EXPECT_THAT(read("AC;240,42;240,28\nBD;240,42;240,57\n", square()),
              HasSubstr("--column \"nominal[mm]=3\""));
  SheetWords stated = square();
  stated.columns = {"nominal[mm]=2", "distance[mm]=3"};
  EXPECT_THAT(read("AC;240,42;240,28\nBD;240,42;240,57\n", stated), HasSubstr("A-C,200,200,0.2,240.28,A\n"));
  EXPECT_THAT(read("Strecke;Soll;Abweichung\nAC;240,42;-0,14\nBD;240,42;0,15\n", square()),
              HasSubstr("\"Abweichung\": this column has no unit: give --unit mm"));
  EXPECT_THAT(read("Strecke;Soll [mm];Soll-Ist [mm]\nAC;240,42;0,14\nBD;240,42;-0,15\n", square()),
              HasSubstr("A-C,200,200,0.2,240.28,A\nB-D,30,200,0.2,240.57,B\n"));
  EXPECT_THAT(read("Strecke;Ist\nAC;240,28\nBD;240,57 schief\n", square()),
              HasSubstr("\"240,57 schief\": not a number"));
  EXPECT_THAT(read("Strecke;Ist\nAC;240,28\nH\u00f6he;20,05\nBD;240,57\n", square()),
              AllOf(StartsWith("point,"),
                    HasSubstr("line 3: \"H\u00f6he\" names no two points: the row is left out")));
  EXPECT_THAT(read("Strecke;Ist\n01.02.2026;170,12\n2026-02-01;169,93\n", square()), HasSubstr("refused"));
}

TEST(PointDistances, ATableWithPositionsIsAnotherTable) {
  EXPECT_THAT(read("Strecke;X [mm];x [mm]\nAB;0;0,1\nBC;50;50,1\nCD;100;100,1\n"),
              StartsWith("Strecke,X[mm],x[mm]\n"));
  EXPECT_THAT(read("X [mm];x [mm]\n0;0,1\n50;50,1\n", square()),
              HasSubstr("\"--point\": the table has no column with pairs of points"));
  // Directions by two letters are no pairs, and neither are words beside a stated axis.
  SheetWords stated;
  stated.columns = {"X[mm]=Pos"};
  stated.deviations = {"X[um]=Abw"};
  EXPECT_THAT(read("Pos;Abw;Feld\n0;1;AB\n50;2;BC\n100;3;CD\n", stated),
              StartsWith("X[mm],x[mm],Feld\n0,0.001,AB\n"));
  EXPECT_THAT(read("Pos;Abw;Anfahrt\n0;1;LR\n50;2;LR\n50;2;RL\n"), Not(HasSubstr("--point")));
  EXPECT_THAT(read("Layer height: 0.2\nWall count: 3\nTop layers: 4\n"), Not(HasSubstr("--point")));
  EXPECT_THAT(read("X [mm];AB [um];CD [um]\n0;1;2\n50;2;3\n"), Not(HasSubstr("--point")));
  EXPECT_THAT(read("Bemerkung;Strecke;Ist [mm]\nsehr gut;AC;240,28\nganz gut;BD;240,57\n", square()),
              HasSubstr("A-C,200,200,0.2,240.28,A,\"sehr gut\"\n"));
  EXPECT_THAT(read("Strecke;Ist [mm]\nAC;240,28\n", with({"A=30,30,0.2", "C=200,200,0.2"})),
              HasSubstr("240.28,A\n"));
  // The planes of a ball bar, and verdicts, are no points.
  EXPECT_THAT(read("Ebene;L\u00e4nge [mm]\nXY;165,49\nYZ;165,51\nXZ;164,62\n"), Not(HasSubstr("--point")));
}

TEST(PointDistances, WordsOfTheOptionAreChecked) {
  const auto said = [](const std::vector<std::string>& words) {
    try {
      stated_points(words, {}, nullptr);
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_THAT(said({"A"}), HasSubstr("has not the form NAME=X,Y,Z"));
  EXPECT_THAT(said({"A=X,Y,Z"}), HasSubstr("the position \"X\" of the point A is not a number"));
  EXPECT_THAT(said({"A=30,30"}), HasSubstr("has 2 positions, and the point needs 3: NAME=X,Y,Z"));
  EXPECT_THAT(said({"A=30,30,0", "A=31,30,0"}), HasSubstr("the point A has two positions"));
  EXPECT_DOUBLE_EQ(stated_points({"A=30,5; 31; 0,2"}, {}, nullptr).points[0].values[0], 30.5);
}

TEST(PointDistances, AListHasThePositionsOfTheMachine) {
  const model::Machine machine = model::parse_machine(
      "<machine name=\"m\"><variables><machineaxes><Y min=\"0\" max=\"300\"/><X min=\"0\" max=\"300\"/>"
      "</machineaxes></variables><transforms><sixdof n=\"1\" X=\"X\" Y=\"Y\"/></transforms></machine>",
      "m.xml");
  // The order of the positions is that of the machine file.
  NamedPoints points = stated_points({"A=7,30"}, {}, &machine);
  EXPECT_EQ(points.points[0].at_mm, (std::array<double, 3>{30, 7, 0}));
  add_listed_points(points, {}, {"Punkt;X [mm];Y [cm]\nA;1;1\nB;200;0,7\nC;5;5\n", "n.csv"}, machine);
  ASSERT_EQ(points.points.size(), 3u);
  EXPECT_EQ(points.points[1].at_mm, (std::array<double, 3>{200, 7, 0}));
  SheetWords words;
  words.points = points;
  EXPECT_THAT(
      read("Strecke;Ist [mm]\nAB;170,12\nBA;170,14\n", words),
      AllOf(StartsWith("point,Y[mm],X[mm],distance[mm],from\nA,7,30,,\nB,7,200,,\nA-B,7,200,170.12,A\n"
                       "B-A,7,30,170.14,B\n"),
            HasSubstr("n.csv: no distance to the point C")));
}

TEST(PointDistances, ReadingsOfOneDistanceThatDifferAreNoted) {
  const std::string rows = "Strecke;Ist\nAB;170,31\nBC;169,84\nAC;240,30\nCA;240,95\nBD;240,79\n";
  EXPECT_THAT(
      read(rows, square()),
      AllOf(HasSubstr("A-C,200,200,0.2,240.3,A\nC-A,30,30,0.2,240.95,C\n"),
            HasSubstr("the readings of the distance of A and C differ by 0.65 mm (240.3 mm in line 4, 240.95 "
                      "mm in line 5), more than 0.1 mm")));
  // 2.8 u for two readings: 0.84 mm, 0.56 mm.
  EXPECT_THAT(read(rows, with(kCorners, {"u[mm]=0.3"})), Not(HasSubstr("differ by")));
  EXPECT_THAT(read(rows, with(kCorners, {"u[um]=200"})), HasSubstr("more than 0.56 mm for u = 0.2 mm"));
}

/// A skewed square of 170 mm: the law of the parallelogram holds for it, and not with a diagonal 0.9 mm
/// wrong. The squareness follows from the difference of the diagonals, so that both of them may be the wrong
/// one.
TEST(PointDistances, ADiagonalThatContradictsTheSidesIsNotedWithBoth) {
  const std::string sides = "AB;170,12\nBC;169,93\nCD;170,12\nAD;169,93\n";
  const std::string right = read(sides + "AC;240,28\nBD;240,64\n", square());
  EXPECT_THAT(right, Not(HasSubstr("contradict each other")));
  const std::string wrong = read(sides + "AC;240,28\nBD;239,74\n", square());
  EXPECT_THAT(wrong, HasSubstr("the sides and diagonals of A, B, C, D contradict each other by 0.88 mm"));
  EXPECT_THAT(wrong,
              HasSubstr("the sides agree with 241.16 mm for A-C (240.28 mm measured), or with 240.62 mm "
                        "for B-D (239.74 mm measured)"));
  EXPECT_THAT(read(sides + "AC;240,28\nBD;239,74\n", with(kCorners, {"u[mm]=0.2"})),
              Not(HasSubstr("contradict each other")));
  EXPECT_THAT(read("AB;170,12\nBC;169,93\nAC;240,28\nBD;239,74\n", square()),
              Not(HasSubstr("contradict each other")))
      << "nothing is redundant";
}

TEST(PointDistances, ADoubtfulUnitIsNamedWithTheRightOne) {
  EXPECT_THAT(read("Seite;Abweichung (1/100)\nAB;31\nBC;-16\nAC;-12\nBD;37\n", square()),
              AllOf(StartsWith("refused: "), HasSubstr("--column \"deviation[0.01mm]=Abweichung (1/100)\""),
                    Not(HasSubstr("--unit mm"))));
  EXPECT_THAT(
      read("Strecke;Soll [mm];Ist [mm]\nAB;17,000;17,031\nBC;17,000;16,984\nAC;24,042;24,030\nBD;24,042;"
           "24,079\n",
           square()),
      AllOf(StartsWith("refused: "), HasSubstr("all of them agree in cm")));
  EXPECT_THAT(
      read("Strecke;Soll;Ist\nAB;170;170,31\nBC;170;169,84\nAC;170;240,30\nBD;170;240,79\n", square()),
      AllOf(StartsWith("refused: "), HasSubstr("correct the nominal distance, or leave out this column")));
}

TEST(PointDistances, ATableInAnotherFormIsRefusedWithTheFormToWrite) {
  EXPECT_THAT(read(";A;B;C;D\nA;0;170,31;240,30;169,81\nB;170,31;0;169,84;240,79\nC;240,30;169,84;0;170,30\n",
                   square()),
              AllOf(StartsWith("refused: "), HasSubstr("write one row for each distance")));
}

}  // namespace
}  // namespace vernier::point_distances_test
