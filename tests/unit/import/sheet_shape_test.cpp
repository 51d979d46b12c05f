// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of another shape than the command reads, and remedies that must not give false data.
#include "tools/import/tables/table_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/reading/sheet_import.h"

namespace vernier::sheet_shape_test {

using namespace vernier::importer;
using testing::HasSubstr;
using testing::Not;
using vernier::importer_test::beside_the_table;
using vernier::importer_test::read;
namespace {

TEST(SheetShape, SignsOfAMeanAreComputedRowsAlsoInAColumnThatIsLeftOut) {
  SheetWords leave;
  leave.left = {"Nr"};
  leave.fill = {"Soll X [mm]"};
  for (const char* label :
       {"Ø", "Mittel", "Mean", "avg", "Σ", "Summe", "min", "max", "s", "Ø 6,15", "MITTELWERT"})
    EXPECT_THAT(
        read("Nr;Soll X [mm];Abweichung X [um]\n1;0;3\n2;50;5\n" + std::string(label) + ";;6,1\n", leave),
        testing::AllOf(testing::StartsWith("X[mm],x[mm]\n0,0.003\n50,50.005\nnote: line 4: the row"),
                       HasSubstr("is computed from the rows above it")))
        << label;
}

TEST(SheetShape, UnitsBetweenTwoLinesOfHeadingsAreReadAsBelowThem) {
  // As a protocol by VDI 3441: names over several columns, units, runs with arrows.
  const std::string table =
      "Sollposition "
      "X;Abweichung;;;;Mittelwert;\nmm;um;um;um;um;um;um\n;1\u2191;1\u2193;2\u2191;2\u2193;x\u2191;x\u2193\n"
      "0;1;6;2;7;1,5;6,5\n50;2;8;3;9;2,5;8,5\n";
  const std::string said = read(table);
  EXPECT_THAT(said, testing::StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.002\n50,-1,1,50.008\n"
                                        "0,-1,1,0.006\n0,1,2,0.002\n"));
  EXPECT_THAT(said, Not(HasSubstr("does not use")));
}

TEST(SheetShape, ReadingsOfEachDirectionBelongToItsPositions) {
  const std::string pairs = "X Soll hin [mm];Abw. X hin [um];X Soll rück [mm];Abw. X rück [um]\n";
  EXPECT_THAT(read(pairs + "0;1;100;4\n50;2;50;5\n100;3;0;6\n"),
              testing::StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.002\n100,1,1,100.003\n"
                                  "100,-1,1,100.004\n50,-1,1,50.005\n0,-1,1,0.006\nnote: the readings"));
  EXPECT_THAT(read("X Soll hin [mm];Abw. X 1 hin [um];X Soll rück [mm];Abw. X 1 rück [um];X Soll hin [mm];"
                   "Abw. X 2 hin [um]\n0;1;9;4;0;1\n9;1;0;4;9;1\n"),
              HasSubstr("a second column of positions in this approach direction"));
}

TEST(SheetShape, DirectionsAreReadOrNoted) {
  EXPECT_THAT(read("X [mm];Abw. X [um];Ri;Lauf\n0;1;H;1\n50;2;H;1\n50;3;R;2\n0;4;R;2\n"),
              testing::StartsWith("X[mm],x[mm],dirX,run\n0,0.001,1,1\n50,50.002,1,1\n50,50.003,-1,2\n"));
  EXPECT_THAT(read("X [mm];Abw. X [um];Lauf\n0;1;Lauf 1 +\n50;2;Lauf 1 +\n50;3;Lauf 2 -\n0;4;Lauf 2 -\n"),
              testing::StartsWith("X[mm],x[mm],run,dirX\n0,0.001,1,1\n50,50.002,1,1\n50,50.003,2,-1\n"));
  const std::string sides = "0;1;von links\n50;2;von links\n50;3;von rechts\n0;4;von rechts\n";
  EXPECT_THAT(read("X [mm];Abw. X [um];Anfahrt\n" + sides),
              HasSubstr("note: \"Anfahrt\" may contain approach directions (links, rechts)"));
  EXPECT_THAT(read("X [mm];Abw. X [um];Lauf\n0;1;Lauf a +\n50;2;Lauf a -\n"),
              HasSubstr("note: \"Lauf\" may contain approach directions (+, -)"));
  EXPECT_THAT(read("X [mm];Abw. X [um];Richtung;Punkt\n0;1;+;links\n50;2;-;rechts\n"),
              Not(HasSubstr("may contain")));
}

TEST(SheetShape, ANoteOfDirectionsNamesTheOptionThatReadsThem) {
  const std::string rows =
      "Soll X [mm];Soll Y [mm];Anfahrt X;Anfahrt Y;Tracker X [mm];Tracker Y [mm]\n"
      "0;0;;+;0,001;0,002\n50;9;+;+;50,002;9,003\n0;4;-;-;0,003;4,004\n";
  const std::string plain = read(rows);
  EXPECT_THAT(plain,
              HasSubstr("is not read as directions: give --column \"dirX=Anfahrt X\"; write 0 into its "
                        "empty cells if the direction is not known"));
  EXPECT_THAT(plain, HasSubstr("is not read as directions: give --column \"dirY=Anfahrt Y\"\n"));
  SheetWords words;
  words.columns = {"dirX=Anfahrt X", "dirY=Anfahrt Y"};
  EXPECT_THAT(read(rows, words),
              HasSubstr("the direction is not known, as before the first motion of the axis, write 0"));
  EXPECT_THAT(read("Soll X [mm];Soll Y [mm];Anfahrt X;Anfahrt Y;Tracker X [mm];Tracker Y [mm]\n"
                   "0;0;0;+;0,001;0,002\n50;9;+;+;50,002;9,003\n0;4;-;-;0,003;4,004\n",
                   words),
              testing::StartsWith("X[mm],Y[mm],dirX,dirY,x[mm],y[mm]\n0,0,0,1,"));
}

TEST(SheetShape, ARowWithAnUnknownWordIsNotFilled) {
  SheetWords fill;
  fill.left = {"Nr"};
  fill.fill = {"Soll X [mm]"};
  EXPECT_THAT(read("Nr;Soll X [mm];Abweichung X [um]\n1;0;3\n2;50;5\nErgebnis;;6,1\n", fill),
              HasSubstr("refused: s.csv:4: \"Ergebnis\": this row has a word where the other rows have a "
                        "number (\"Nr\"), and no value for \"Soll X [mm]\""));
  EXPECT_THAT(read("Nr;Soll X [mm];Abweichung X [um]\n1;0;3\n2;;5\n", fill),
              testing::StartsWith("X[mm],x[mm]\n0,0.003\n0,0.005\n"));
}

TEST(SheetShape, AnUnstatedUnitOfADeviationIsNotGuessed) {
  const std::string small = read("X;Abweichung\n0;0,0028\n300;0,0155\n");
  EXPECT_THAT(small,
              HasSubstr("--deviation \"X[mm]=Abweichung\", or --deviation \"X[um]=Abweichung\": only you "
                        "know the unit of \"Abweichung\"; its largest value 0.0155 is 0.0155 mm or "
                        "0.0155 um"));
  EXPECT_THAT(small, Not(HasSubstr("--unit")));
  EXPECT_THAT(read("X;Abweichung\n0;2,8\n300;15,5\n"),
              HasSubstr("--deviation \"X[um]=Abweichung\", or --deviation \"X[mm]=Abweichung\""));
}

TEST(SheetShape, QuantitiesInRowsAreRefused) {
  const std::string table = "Soll X [mm];0;50;100;150\nAbweichung X [um];3,0;4,5;7,0;9,0\n";
  EXPECT_THAT(read(table), HasSubstr("refused: s.csv:1: the first column has the headings (\"Soll X [mm]\", "
                                     "\"Abweichung X [um]\")"));
  SheetWords words;
  words.columns = {"x[mm]=2"};
  EXPECT_THAT(read(table, words), HasSubstr("transpose the table"));
  EXPECT_THAT(read("Punkt;1;2;3\nSoll X [mm];0;50;100\nIst X [mm];0,1;50,1;100,2\n"),
              HasSubstr("transpose the table"));
  EXPECT_THAT(read("Soll;mm;0;50;100\nIst;mm;0,1;50,1;100,2\n"), HasSubstr("transpose the table"));
}

TEST(SheetShape, LabelsOfRowsAreNoTransposedTable) {
  EXPECT_EQ(read("Punkt;X [mm];x [mm]\nP1;0;1\nP2;9;10\n"), "Punkt,X[mm],x[mm]\nP1,0,1\nP2,9,10\n");
  EXPECT_THAT(read("Art;X [mm];x [mm]\nactual;0;1\nmeasured;9;10\n"),
              testing::StartsWith("Art,X[mm],x[mm]\nactual,0,1\nmeasured,9,10\n"));
}

TEST(SheetShape, RoundActualsBesideUnevenTargetsGetANote) {
  const std::string exchanged = read("Ist X [mm];Soll X [mm]\n0;0,0033\n50;50,0047\n100;100,0064\n");
  EXPECT_THAT(exchanged, HasSubstr("note: the values of \"Ist X [mm]\" are round numbers"));
  EXPECT_THAT(exchanged, HasSubstr("--column \"X=Ist X [mm]\" --column \"x=Soll X [mm]\""));
  EXPECT_THAT(read("Soll X [mm];Ist X [mm]\n0;0,0033\n50;50,0047\n100;100,0064\n"), Not(HasSubstr("note")));
  EXPECT_THAT(read("Soll X [mm];Ist X [mm]\n0,01;0,0133\n50,2;50,2047\n100;100,0064\n"),
              Not(HasSubstr("note")));
  SheetWords words;
  words.columns = {"X=Ist X [mm]", "x=Soll X [mm]"};
  const std::string assigned = read("Ist X [mm];Soll X [mm]\n0;0,0033\n50;50,0047\n100;100,0064\n", words);
  EXPECT_THAT(assigned, testing::StartsWith("X[mm],x[mm]\n0,0.0033\n50,50.0047\n"));
  EXPECT_THAT(assigned, Not(HasSubstr("note")));
}

TEST(SheetShape, TwoDecimalSignsNameTheCellsAndTheCorrection) {
  const std::string table = "Soll X [mm];Abweichung X [um]\n0;3.0\n50;5,0\n100;7.2\n";
  EXPECT_THAT(read(table),
              HasSubstr("refused: s.csv:3: \"5,0\": a decimal comma here, a decimal point in line "
                        "2 (3.0); 1 cell with a comma, 2 cells with a point: write all numbers "
                        "of the file with one decimal sign"));
  SheetWords comma, point;
  comma.decimal = "comma", point.decimal = "point";
  EXPECT_THAT(read(table, comma), HasSubstr("refused: s.csv:2: \"3.0\": not a number, for X: this cell has a "
                                            "decimal point, and the table is read with a decimal comma"));
  EXPECT_THAT(read(table, point), HasSubstr("refused: s.csv:3: \"5,0\": not a number, for X: this cell has a "
                                            "decimal comma, and the table is read with a decimal point"));
}

TEST(SheetShape, DocumentsWithTheNameOfATableAreNamed) {
  EXPECT_THAT(read("<html><table><tr><td>X</td></tr></table></html>"), HasSubstr("a web page (HTML)"));
  EXPECT_THAT(read("\xEF\xBB\xBF\r\n<!DOCTYPE html>\n<html></html>\n"), HasSubstr("a web page (HTML)"));
  EXPECT_THAT(read("<?xml version=\"1.0\"?>\n<Workbook "
                   "xmlns=\"urn:schemas-microsoft-com:office:spreadsheet\"></Workbook>\n"),
              HasSubstr("a workbook as XML"));
  EXPECT_THAT(read("%PDF-1.7\n"), HasSubstr("a document (PDF)"));
}

TEST(SheetShape, ARowOfMoreWordsThanNumbersIsNamed) {
  EXPECT_THAT(
      read("Ort;Teil;Abstand [mm]\nHalle;Tisch;141,27\nHalle;Arm;141,69\n"),
      HasSubstr("refused: s.csv:2: \"Halle; Tisch; 141,27\": this row has more words than numbers "
                "(number: 141,27): a row of measured data needs the positions of the axes as numbers"));
}

/// A table with one deviation per 50 mm, in um.
std::string along_x(const std::vector<std::string>& cells, const std::string& title = "") {
  std::string text = title + "X [mm];Abweichung X [um]\n";
  for (std::size_t i = 0; i < cells.size(); ++i) text += std::to_string(50 * i) + ";" + cells[i] + "\n";
  return text;
}

TEST(SheetCells, AColumnInTwoUnitsIsRefused) {
  const std::string table =
      along_x({"-0,1", "3,7", "6,9", "8,7", "10,6", "0,0117", "0,0120", "0,0135", "0,0148"});
  EXPECT_THAT(
      read(table),
      testing::StartsWith("refused: s.csv:7: \"Abweichung X [um]\": in this line and in 3 more the "
                          "deviations have more decimals and are about 13.5 nm, in the other lines about "
                          "6.9 um: the lines do not have the same unit"));
  SheetWords words;
  words.deviations = {"X[um]=Abweichung X [um]"};
  EXPECT_THAT(read(table, words), HasSubstr("note: \"Abweichung X [um]\", line 7: in this line"));
  // Small deviations near the zero of the instrument have the decimals of the other ones.
  EXPECT_THAT(read(along_x({"0,00", "0,01", "0,01", "0,02", "8,71", "9,22", "9,95", "10,31"})),
              testing::StartsWith("X[mm],x[mm]\n"));
}

TEST(SheetCells, AnOutlierIsReadWithANote) {
  const std::string lost =
      read(along_x({"-0,1", "3,7", "6,9", "8,7", "10,6", "111", "11,7", "12,0", "13,5"}));
  EXPECT_THAT(lost, HasSubstr("250,250.111\n"));
  EXPECT_THAT(lost,
              HasSubstr("note: line 7, \"111\": the deviation 0.111 mm of \"Abweichung X [um]\" is far "
                        "outside the deviations of the lines before and behind it (8.7 um to 0.012 mm); "
                        "1/10 of this value agrees with them: is a decimal sign lost?"));
  EXPECT_THAT(read(along_x({"15,3", "15,9", "16,2", "0,017", "16,8", "17,1", "17,2"})),
              HasSubstr("1000 times this value agrees with them: has the cell another unit?"));
  EXPECT_THAT(read(along_x({"1,5", "2,2", "1,2", "2,8", "85,0", "3,5", "2,1", "1,4"})),
              HasSubstr("(1.2 um to 3.5 um). The value is read"));
  // A reversal error between two runs is no outlier.
  EXPECT_THAT(read(along_x({"1,0", "1,2", "1,5", "1,9", "9,9", "9,5", "9,2", "9,0"})),
              Not(HasSubstr("note")));
}

TEST(SheetRows, ARowThatSaysThatItIsInvalidIsOmitted) {
  const auto table = [](const std::string& remark) {
    return "X [mm];Abweichung X [um];Bemerkung\n0;1;\n50;2;" + remark + "\n50;3;wiederholt\n100;4;\n";
  };
  const std::string omitted = read(table("ungültig, Strahl unterbrochen"));
  EXPECT_THAT(omitted, Not(HasSubstr("50.002")));
  EXPECT_THAT(omitted,
              HasSubstr("note: line 3: this row says \"ungültig, Strahl unterbrochen\" and is omitted"));
  EXPECT_THAT(read(table("invalid (beam)")), HasSubstr("note: line 3: this row says"));
  EXPECT_THAT(read(table("not valid")), HasSubstr("note: line 3: this row says"));
  for (const char* const valid : {"gültig", "ungültig?", "nicht ungültig", "not discarded", "valid"})
    EXPECT_THAT(read(table(valid)), HasSubstr("50.002")) << valid;
  // A column of answers, or of marks.
  const std::string answers = read("X [mm];dX [um];gültig\n0;1;ja\n50;2;nein\n100;4;ja\n");
  EXPECT_THAT(answers, Not(HasSubstr("50.002")));
  EXPECT_THAT(answers, HasSubstr("note: line 3: this row says \"gültig: nein\" and is omitted"));
  const std::string marks = read("ungültig;X [mm];dX [um]\n;0;1\nx;50;2\n;100;4\n");
  EXPECT_THAT(marks, Not(HasSubstr("50.002")));
  EXPECT_THAT(marks, HasSubstr("note: line 3: this row says \"ungültig: x\" and is omitted"));
  // Out of tolerance is not invalid.
  EXPECT_THAT(read("X [mm];dX [um];Status\n0;1;i.O.\n50;2;n.i.O.\n100;4;i.O.\n"), HasSubstr("50.002"));
  EXPECT_THAT(read("X [mm];dX [um];Status\n0;1;invalid\n50;2;invalid\n"),
              HasSubstr("refused: s.csv:2: \"invalid\": each row of the table says that it is invalid"));
}

TEST(SheetRows, TheMeanOfRunsIsNoReadingWhateverItsSign) {
  for (const char* const mean : {"x\u0304", "x\u0305", "Ø", "Mittel", "moyenne"}) {
    const std::string out = read("X [mm];Lauf 1 [um];Lauf 2 [um];" + std::string(mean) +
                                 " [um]\n0;1;2;1,5\n50;3;4;3,5\n100;5;6;5,5\n150;7;8;7,5\n");
    EXPECT_THAT(out, HasSubstr("50,1,50.003\n")) << mean;
    EXPECT_THAT(out, Not(HasSubstr("50.0035"))) << mean;
  }
}

TEST(SheetTitle, ATitleOfAnotherAxisIsRefusedWithBothRemedies) {
  const std::string table = along_x({"1", "2", "3"}, "Achse: Y\n");
  EXPECT_EQ(
      read(table),
      "refused: s.csv:2: \"Achse: Y\": this title states the axis Y, and the headings have the positions of "
      "X. If the title is right, give --column \"Y=X [mm]\" --deviation \"Y=Abweichung X [um]\"; if the "
      "headings are right, give --column \"X=X [mm]\"");
  SheetWords title, headings, still;
  title.columns = {"Y=X [mm]"}, title.deviations = {"Y=Abweichung X [um]"};
  headings.columns = {"X=X [mm]"};
  still.constants = {"Y[mm]=250"};
  EXPECT_THAT(read(table, title), testing::StartsWith("Y[mm],y[mm]\n0,0.001\n"));
  EXPECT_THAT(read(table, headings), testing::StartsWith("X[mm],x[mm]\n0,0.001\n"));
  EXPECT_THAT(read(table, still), testing::StartsWith("X[mm],x[mm],Y[mm]\n0,0.001,250\n"));
  for (const char* const other : {"Achse X\n", "Achse Y = 250 mm\n", "Y-Achse bei 250\n",
                                  "parallel zur Y-Achse\n", "Maschine Y, Achse X\n"})
    EXPECT_THAT(read(along_x({"1", "2", "3"}, other)), testing::StartsWith("X[mm],x[mm]\n")) << other;
}

TEST(SheetTitle, OfARisingOrFallingRunIsADirection) {
  const std::string two =
      "Messreihe 1 steigend\nX [mm];dX [um]\n0;1\n50;2\n100;3\n\nMessreihe 2 fallend\nX [mm];dX "
      "[um]\n100;4\n50;5\n0;6\n";
  SheetWords words;
  words.table = 2;
  EXPECT_THAT(read(two, words), testing::HasSubstr("100,100.004,-1,2\n50,50.005,-1,2\n0,0.006,-1,2\n"));
}

TEST(SheetTitle, TheRunOfATitleIsReadWithItsTable) {
  const std::string tables =
      "Lauf 1 vorwärts\nX [mm];dX [um]\n0;1\n50;2\n100;3\n\nLauf 2 rückwärts\nX [mm];dX "
      "[um]\n100;5\n50;4\n0;3\n";
  SheetWords words;
  words.table = 2;
  EXPECT_EQ(read(tables, words),
            "X[mm],x[mm],dirX,run\n100,100.005,-1,2\n50,50.004,-1,2\n0,0.003,-1,2\nnote: the title \"Lauf 2 "
            "rückwärts\" states the run 2 and the approach direction - of this table: each row gets both\n" +
                beside_the_table("line 1 \"Lauf 1 vorwärts\""));
  words.constants = {"run=b"};
  EXPECT_THAT(read(tables, words), testing::StartsWith("X[mm],x[mm],dirX,run\n100,100.005,-1,b\n"));
}

TEST(SheetRows, RowsOfSeveralAxesAreReadWithThePositionsOfTheOthers) {
  const std::string table =
      "Achse;Soll [mm];Ist [mm];Richtung\nX;0;0,001;hin\nX;50;50,002;hin\nY;10;10,003;zurück\n";
  EXPECT_THAT(read(table),
              HasSubstr("refused: s.csv:1: \"Achse\": the rows belong to the axes X, Y of this column, "
                        "and a row needs the position of every axis: state where each axis stood while "
                        "the others moved, for example --set \"X[mm]=0\" --set \"Y[mm]=0\" (0 is an "
                        "example)"));
  SheetWords words;
  words.constants = {"X[mm]=7", "Y[um]=250", "Z[mm]=3"};
  EXPECT_EQ(
      read(table, words),
      "X[mm],Y[mm],x[mm],y[mm],dirX,dirY,Z[mm]\n0,0.25,0.001,,1,0,3\n50,0.25,50.002,,1,0,3\n"
      "7,10,,10.003,0,-1,3\nnote: the rows belong to the axes X, Y by the column \"Achse\"; in the rows of "
      "another axis an axis has the position of --set\n");
  EXPECT_THAT(read("Achse;Soll [mm];Abw. [um]\nZ;0;1\nZ;5;2\n"),
              testing::StartsWith("Z[mm],z[mm]\n0,0.001\n5,5.002\n"));
  // The axis of a run may be in its first row only.
  EXPECT_THAT(read("Achse;Soll [mm];Ist [mm]\nZ;0;0,001\n;5;5,002\n"),
              testing::StartsWith("Z[mm],z[mm]\n0,0.001\n5,5.002\n"));
}

TEST(SheetRows, RunsSideBySideWithTheirPositionsAreReadOneBelowTheOther) {
  EXPECT_EQ(
      read("Lauf 1;;;Lauf 2;;\nX [mm];Abw. [um];;X [mm];Abw. [um];\n0;1;;0;3;\n50;2;;50;4;\n"),
      "X[mm],x[mm],run\n0,0.001,1\n50,50.002,1\n0,0.003,2\n50,50.004,2\nnote: the runs 1, 2 are side by "
      "side, each with its own positions: their rows are read one run below the other, with a column run\n");
  const std::string bare =
      "Lauf 1;;;Lauf 2;;\nPos [mm];Abw. [um];;Pos [mm];Abw. [um];\n0;1;;0;3;\n50;2;;50;4;\n";
  EXPECT_THAT(read(bare), HasSubstr("such as --column \"X=Pos [mm]\" --deviation \"X=Abw. [um]\";"));
  SheetWords words;
  words.columns = {"X=Pos [mm]"}, words.deviations = {"X=Abw. [um]"};
  EXPECT_THAT(read(bare, words), HasSubstr("50,50.002,1\n0,0.003,2\n50,50.004,2\n"));
}

TEST(SheetRows, TextsBelowAreOmittedBesideAComputedRow) {
  EXPECT_EQ(
      read("Soll X [mm];Ist X [mm]\n0;0,001\n50;50,002\n\n-;-\ngeprüft: Huber;\nMax. Abweichung [µm];18,5\n"),
      "X[mm],x[mm]\n0,0.001\n50,50.002\nnote: line 7: the row \"Max. Abweichung [µm]\" is computed from the "
      "rows above it and is omitted\n" +
          beside_the_table("line 6 \"geprüft: Huber\""));
}

TEST(SheetCells, DegreesMinutesAndSecondsAreDecimalDegrees) {
  EXPECT_EQ(
      read("C soll;C ist\n0°00'00\";-0°00'01\"\n30°30'00\";30°30'03,6\"\n60°00'00\";60°0'0\"\n"),
      "C[deg],rz[deg]\n0,-0.000277778\n30.5,30.501\n60,60\nnote: cells with degrees, minutes and seconds are "
      "read as decimal degrees\n");
}

TEST(SheetWordsOfOtherLanguages, FrenchHeadingsAreRead) {
  EXPECT_THAT(read("Cote X (mm);Écart X (µm)\n0;1\n50;2\n"), testing::StartsWith("X[mm],x[mm]\n0,0.001\n"));
}

TEST(SheetRemedy, OneTextAboveSeveralColumnsIsNoHeading) {
  for (const char* title : {"Achse X, Position mm, Abweichung µm", "Position mm, Abweichung µm"})
    EXPECT_THAT(read(std::string(title) + "\n0;0,4\n60;2,1\n120;-1,3\n180;3,8\n"),
                HasSubstr("such as --column \"X[mm]=1\" --deviation \"X[um]=2\""));
  SheetWords words;
  words.columns = {"X[mm]=1"};
  words.deviations = {"X[um]=2"};
  EXPECT_THAT(read("Position mm, Abweichung µm\n0;0,4\n60;2,1\n120;-1,3\n180;3,8\n", words),
              AllOf(testing::StartsWith("X[mm],x[mm]\n0,0.0004\n60,60.0021\n"),
                    HasSubstr("is one text above 2 columns")));
}

TEST(SheetRemedy, AColumnWithoutAHeadingIsNoInputWithoutAWord) {
  SheetWords words;
  words.columns = {"X[mm]=1"};
  words.deviations = {"X[um]=2"};
  const std::string table = "0;0,4;0,9\n60;2,1;2,6\n120;-1,3;-0,7\n180;3,8;3,1\n";
  EXPECT_THAT(read(table, words), HasSubstr("column 3 has no heading and is read as an input"));
  words.left = {"3"};
  EXPECT_THAT(read(table, words), Not(HasSubstr("has no heading")));
}

TEST(SheetRemedy, AUnitForAllIsNotNamedBesideAnotherUnit) {
  EXPECT_THAT(read("everything metric, errors in microns\nX target;Deviation X\n0;0.4\n60;2.1\n120;-1.3\n"),
              AllOf(HasSubstr("no unit: give it for each, such as --column \"X[mm]=X target\""),
                    testing::Not(HasSubstr("--unit"))));
}

TEST(SheetRemedy, TheValuesDecideWhichAssignmentIsNamed) {
  const auto table = [](const std::string& heading, const std::vector<std::string>& cells) {
    std::string text = heading + "\n";
    for (std::size_t i = 0; i < cells.size(); ++i) text += std::to_string(50 * i) + ";" + cells[i] + "\n";
    return text;
  };
  EXPECT_THAT(read(table("X [mm];Mittelwert [um]", {"1", "2", "4", "3"})),
              HasSubstr("such as --deviation \"X=Mittelwert [um]\" (the values are small compared with the "
                        "positions) if they are deviations, actual - nominal; for nominal - actual, such as "
                        "corrections or remaining distances, add --sign nominal-actual; sum changes from row "
                        "to row in the file first;"));
  EXPECT_THAT(read(table("X [mm];Wert [mm]", {"0,001", "50,002", "100,003", "150,002"})),
              HasSubstr("such as --column \"x=Wert [mm]\" (the values follow the positions);"));
  EXPECT_THAT(read(table("X [mm];Schrittweite ist [mm]", {"0,0000", "50,0020", "50,0030", "49,9980"})),
              HasSubstr("first replace the values of \"Schrittweite ist [mm]\" in the file by their sums"));
  const std::string opposite =
      table("X Anzeige [mm];Laser [mm]", {"0,001", "-50,002", "-100,003", "-150,002"});
  EXPECT_THAT(read(opposite),
              HasSubstr("such as --column \"X=X Anzeige [mm]\" --column \"x=Laser [mm]\", but first "
                        "change the sign of \"Laser [mm]\" in the file"));
  SheetWords words;
  words.columns = {"X=X Anzeige [mm]", "x=Laser [mm]"};
  EXPECT_THAT(read(table("X Anzeige [mm];Laser [mm]", {"-0,001", "50,002", "100,003", "150,002"}), words),
              testing::StartsWith("X[mm],x[mm]\n0,-0.001\n50,50.002\n"));
}

}  // namespace
}  // namespace vernier::sheet_shape_test
