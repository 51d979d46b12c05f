// SPDX-License-Identifier: GPL-3.0-or-later
// Workshop tables with a value or a column that could mean two things: the other cells decide, or the message
// states what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/tables/directions.h"
#include "tools/import/tables/doubled.h"
#include "tools/import/tables/sheet_import.h"
#include "tools/import/tables/thousands.h"
#include "tools/sheet/workbook_writer.h"

namespace vernier::sheet_meaning_test {

using namespace vernier::importer;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

struct Case {
  const char* name;
  const char* bytes;
  const char* read;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

const Case kCases[] = {
    // An error beside a displayed position.
    {"ErrorBesideADisplayedActual", "Soll X [mm];Ist X [mm];Fehler X [um]\n0;0;1\n100;100;3\n200;200;5\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n200,200.005\n"},
    {"ErrorBesideADisplayedActualWithDecimals",
     "X soll [mm];X ist [mm];Abw. [um]\n0;0,0;1\n100;100,0;3\n200;200,0;5\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n200,200.005\n"},
    {"ErrorBesideTheDisplayAlone", "Anzeige X [mm];Fehler [um]\n0;1\n100;3\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n"},
    {"ErrorBesideCommandAndDisplay", "Kommandiert X [mm];Anzeige X [mm];Error [um]\n0;0;1\n100;100;3\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n"},
    {"DeviationComputedFromTheActual", "Soll X [mm];Ist X [mm];Fehler X [um]\n0;0,001;1\n100;100,003;3\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n"},
    {"DeviationOfTheOtherSignComputedFromTheActual",
     "Soll X [mm];Ist X [mm];Fehler X [um]\n0;0,001;-1\n100;100,003;-3\n",
     "X[mm],x[mm]\n0,0.001\n100,100.003\n"},
    {"DeviationThatContradictsTheActual", "Soll X [mm];Ist X [mm];Fehler X [um]\n0;0,001;1\n100;100,003;40\n",
     "refused: s.csv:3: \"40\": \"Ist X [mm]\" minus the target is 3 um in this row, and \"Fehler X [um]\" "
     "states "
     "another value: the two columns contradict each other. Read one of them: --leave \"Ist X [mm]\" or "
     "--leave "
     "\"Fehler X [um]\""},
    {"MeanDeviationBesideTheActual",
     "Soll X [mm];Ist X [mm];Mittlere Abweichung X [um]\n0;0,001;2\n0;0,003;2\n9;9,001;1\n",
     "X[mm],x[mm]\n0,0.001\n0,0.003\n9,9.001\n"},
    // Thousands.
    {"ThePositionBesideDecides", "X [mm];x [mm]\n0;0.001\n500;500.002\n1.000;1000.002\n",
     "X[mm],x[mm]\n0,0.001\n500,500.002\n1000,1000.002\nnote: \"X [mm]\": 1 cell such as \"1.000\" (line 4) "
     "is "
     "read as 1000, because the position beside it agrees; if this is wrong, give --decimal point\n"},
    {"OneCellOfAColumnWithDecimals", "X [mm];x [mm]\n500;500.002\n1000;1.000\n2000;2000.004\n",
     "X[mm],x[mm]\n500,500.002\n1000,1000\n2000,2000.004\nnote: \"x [mm]\": 1 cell such as \"1.000\" (line "
     "3)"},
    {"TheCommaBetweenThousands", "X [mm];x [mm]\n0;0,001\n500;500,002\n1,000;1000,002\n",
     "X[mm],x[mm]\n0,0.001\n500,500.002\n1000,1000.002\nnote: "},
    {"ADecidedCellDecidesTheCellBesideIt", "X [mm];x [mm]\n0;0.001\n500;500.002\n1.000;1.000\n",
     "X[mm],x[mm]\n0,0.001\n500,500.002\n1000,1000\nnote: "},
    {"TheSizeOfTheWholeNumbersDecides", "X [mm];Abw. X [um]\n0;1\n500;2\n1.000;2\n1.500;1\n",
     "X[mm],x[mm]\n0,0.001\n500,500.002\n1000,1000.002\n1500,1500.001\nnote: "},
    {"ThirdsAreDecimals", "X [mm];Abw. X [um]\n0;1.5\n33.333;2\n66.667;2\n100;1\n",
     "X[mm],x[mm]\n0,0.0015\n33.333,33.335\n66.667,66.669\n100,100.001\n"},
    {"ThreeDecimalsInEachCell", "X [mm];x [mm]\n0.000;0.001\n1.000;1.002\n2.000;2.003\n",
     "X[mm],x[mm]\n0.000,0.001\n1.000,1.002\n2.000,2.003\n"},
    {"NoOtherCellDecides", "X [mm];Abw. X [um]\n0;1.2\n1.000;1.5\n2.000;2.5\n",
     "refused: s.csv:3: \"1.000\": this cell of \"X [mm]\" can be 1 or 1000: the column has whole numbers "
     "too, and "
     "no other cell decides. If the cell is 1, give --decimal point; if the cell is 1000, write 1000 into "
     "the "
     "file"},
    // Signs in words.
    {"PositiveWhenShort", "positive when short\nTarget X [mm];Error X [um]\n100;1.5\n200;2.5\n",
     "X[mm],x[mm]\n100,99.9985\n200,199.9975\nnote: the sign of the deviations is nominal - actual, by the "
     "text "
     "\"positive when short\"; if this is wrong, give --sign actual-nominal\n"},
    {"PositivWennZuKurz", "Bemerkung: positiv, wenn zu kurz\nSoll X [mm];Abweichung X [um]\n100;1,5\n200;1\n",
     "X[mm],x[mm]\n100,99.9985\n200,199.999\nnote: "},
    {"TheSignBelowTheTable", "Soll X [mm];Fehler X [um]\n100;1,5\n200;2\n\nBemerkung: Fehler = Soll - Ist\n",
     "X[mm],x[mm]\n100,99.9985\n200,199.998\nnote: line 5: \"Bemerkung: Fehler = Soll - Ist\" is a text "
     "below the "
     "table and is omitted\nnote: the sign of the deviations is nominal - actual"},
    // Directions.
    {"NoughtIsTheAscendingDirection",
     "X [mm];x [mm];Richtung\n0;0,1;0\n1;1,1;0\n2;2,1;0\n2;2,2;1\n1;1,2;1\n0;0,2;1\n",
     "X[mm],x[mm],dirX\n0,0.1,1\n1,1.1,1\n2,2.1,1\n2,2.2,-1\n1,1.2,-1\n0,0.2,-1\nnote: \"Richtung\": 0 is "
     "the "
     "direction of increasing positions of X, by the order of the positions in the rows\n"},
    {"OneAndNoughtWithoutAnOrder", "X [mm];x [mm];Richtung\n0;0,1;1\n0;0,2;0\n5;5,1;1\n5;5,2;0\n",
     "X[mm],x[mm],dirX\n0,0.1,1\n0,0.2,-1\n5,5.1,1\n5,5.2,-1\nnote: \"Richtung\": 1 is read as the direction "
     "of "
     "increasing positions of X, 0 as the other one, and the order of the positions does not show the "
     "direction; "
     "if this is wrong, write + and - in this column\n"},
    {"VAndR", "X [mm];x [mm];Richtung\n0;0,1;V\n1;1,1;R\n", "X[mm],x[mm],dirX\n0,0.1,1\n1,1.1,-1\n"},
    {"RunAndDirectionInOneCell", "X [mm];x [mm];Lauf\n0;0,1;1+\n1;1,1;1+\n1;1,2;1-\n0;0,2;1-\n",
     "X[mm],x[mm],run,dirX\n0,0.1,1,1\n1,1.1,1,1\n1,1.2,1,-1\n0,0.2,1,-1\nnote: \"Lauf\" has the run and the "
     "approach direction in one cell: they are read as two columns\n"},
    {"LeftAndRightByTheOrder",
     "X [mm];x [mm];Richtung\n0;0,1;re\n1;1,1;re\n2;2,1;re\n2;2,2;li\n1;1,2;li\n0;0,2;li\n",
     "X[mm],x[mm],dirX\n0,0.1,1\n1,1.1,1\n2,2.1,1\n2,2.2,-1\n1,1.2,-1\n0,0.2,-1\nnote: \"Richtung\": re is "
     "the "
     "direction of increasing positions of X"},
    {"LeftAndRightWithoutAnOrder", "X [mm];x [mm];Richtung\n0;0,1;re\n1;1,1;li\n",
     "refused: s.csv:2: \"re\": not an approach direction, for dirX: write + or -"},
    {"HinTowardSmallerPositions",
     "X [mm];x [mm];Richtung\n0;0,1;hin\n-1;-0,9;hin\n-2;-2;hin\n-2;-2;zurück\n-1;-1;zurück\n0;0;zurück\n",
     "X[mm],x[mm],dirX\n0,0.1,-1\n-1,-0.9,-1\n-2,-2,-1\n-2,-2,1\n-1,-1,1\n0,0,1\nnote: \"Richtung\": zurück "
     "is the "
     "direction of increasing positions of X"},
    {"HinOfAWideTableTowardSmallerPositions", "X soll [mm];hin [um];zur. [um]\n0;1;2\n-1;3;4\n-2;5;6\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n-1,1,1,-0.997\n-2,1,1,-1.995\n0,-1,1,0.002\n-1,-1,1,-0.996\n-2,-1,1,"
     "-1."
     "994\nnote: \"hin [um]\" is read as the approach in the direction of increasing positions"},
    // Headings.
    {"DeltaBesideTargetAndActual", "Soll X [mm];Ist X [mm];\u0394 [um]\n0;0,001;1\n100;100,002;2\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"DeltaIsADeviation", "Soll X [mm];\u2206 [um]\n0;1\n100;2\n", "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"DeltaOfATemperatureIsNone", "Soll X [mm];Ist X [mm];\u0394 T [K]\n0;0,001;1\n100;100,002;2\n",
     "X[mm],x[mm],d_T[K]\n0,0.001,1\n100,100.002,2\n"},
    {"DisplayAndLaser", "Anzeige X [mm];Laser X [mm]\n0;0,001\n100;100,002\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"DisplayAndLaserOfTheTitlesAxis", "Achse: X\nAnzeige [mm];Laser [mm]\n0;0,001\n100;100,002\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"StraightnessWithItsSymbol", "X soll [mm];Y soll [mm];Geradheit EYX [um]\n0;50;1\n100;50;2\n",
     "X[mm],Y[mm],y[mm]\n0,50,50.001\n100,50,50.002\n"},
    {"NennmassAndIstmass", "Nennmaß X [mm];Istmaß X [mm]\n0;0,001\n100;100,002\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"ForthAndBackBesideEachOther", "X soll [mm];Abw. vor [um];Abw. zur. [um]\n0;1;2\n100;3;4\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n100,1,1,100.003\n0,-1,1,0.002\n100,-1,1,100.004\n"},
};

class SheetMeaning : public testing::TestWithParam<Case> {};

TEST_P(SheetMeaning, IsDecidedByOtherCellsOrStatedByTheUser) {
  EXPECT_THAT(read(GetParam().bytes), StartsWith(GetParam().read));
}
INSTANTIATE_TEST_SUITE_P(WorkshopTables, SheetMeaning, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(SheetMeaningRemedy, TheColumnsOfAContradictionAreReadWithTheOptionOfTheMessage) {
  const std::string table = "Soll X [mm];Ist X [mm];Fehler X [um]\n0;0,001;1\n100;100,003;40\n";
  SheetWords without_actual, without_error;
  without_actual.left = {"Ist X [mm]"};
  without_error.left = {"Fehler X [um]"};
  EXPECT_EQ(read(table, without_actual), "X[mm],x[mm]\n0,0.001\n100,100.04\n");
  EXPECT_EQ(read(table, without_error), "X[mm],x[mm]\n0,0.001\n100,100.003\n");
}

TEST(SheetMeaningRemedy, TheStatedDecimalSignIsNotDoubted) {
  SheetWords point;
  point.decimal = "point";
  EXPECT_EQ(read("X [mm];Abw. X [um]\n0;1.2\n1.000;1.5\n2.000;2.5\n", point),
            "X[mm],x[mm]\n0,0.0012\n1.000,1.0015\n2.000,2.0025\n");
}

TEST(SheetMeaningRemedy, NennmassAndIstmassWithoutAnAxisNameTheWorkingAssignment) {
  const std::string table = "Nennmaß [mm];Istmaß [mm]\n0;0,001\n100;100,002\n";
  EXPECT_THAT(read(table), HasSubstr("--column \"X=Nennmaß [mm]\" --column \"x=Istmaß [mm]\""));
  SheetWords words;
  words.columns = {"X=Nennmaß [mm]", "x=Istmaß [mm]"};
  EXPECT_EQ(read(table, words), "X[mm],x[mm]\n0,0.001\n100,100.002\n");
}

TEST(SheetMeaningRemedy, ErrorsForthAndBackWithoutAnAxisNameTheWorkingAssignment) {
  const std::string table = "Position;Fehler vor;Fehler zurück\n0;1,2;3,4\n100;2,2;4,1\n";
  EXPECT_THAT(read(table), HasSubstr("such as --column \"X[mm]=Position\" --deviation \"X[um]=Deviation\""));
  SheetWords words;
  words.columns = {"X[mm]=Position"};
  words.deviations = {"X[um]=Deviation"};
  EXPECT_EQ(read(table, words),
            "X[mm],dirX,run,x[mm]\n0,1,1,0.0012\n100,1,1,100.0022\n0,-1,1,0.0034\n100,-1,1,100.0041\n");
}

TEST(SheetMeaningRemedy, AStraightnessWithoutASymbolIsNotPutOnOneAxis) {
  const std::string refused = read("X [mm];Y [mm];x [mm];Geradheit [um]\n0;5;0;1\n100;5;100;2\n");
  EXPECT_THAT(refused, StartsWith("X[mm],Y[mm],x[mm]\n"));
  const SheetReading reading =
      read_as_sheet("X [mm];x [mm];Geradheit [um]\n0;0;1\n100;100;2\n", "s.csv", SheetWords());
  EXPECT_THAT(reading.columns[2].why,
              HasSubstr("--deviation \"Y[um]=Geradheit [um]\" or --deviation \"Z[um]="));
}

TEST(SheetMeaningOfACover, TheCoverSheetStatesTheSign) {
  const sheet::SheetToWrite
      table = {"X", {{"Soll X [mm]", "Abweichung X [um]"}, {"100", "1.5"}, {"200", "1"}}},
      cover = {"Deckblatt", {{"Maschine", "Portal 4"}, {"Fehler = Soll - Ist"}}},
      other = {"Y",
               {{"Abweichung = Soll - Ist"}, {"Soll Y [mm]", "Abweichung Y [um]"}, {"1", "1.5"}, {"2", "1"}}};
  EXPECT_EQ(
      read(sheet::workbook_of({cover, table})),
      "X[mm],x[mm]\n100,99.9985\n200,199.999\nnote: the sign of the deviations is nominal - actual, by the "
      "text \"sheet Deckblatt: Fehler = Soll - Ist\"; if this is wrong, give --sign actual-nominal\n");
  // Another table states the sign of its own deviations.
  EXPECT_EQ(
      read(sheet::workbook_of({table, other})),
      "X[mm],x[mm]\n100,100.0015\n200,200.001\nnote: the sheet Y has the text \"Abweichung = Soll - Ist\"; "
      "if it is about this sheet too, give --sign nominal-actual or --sign actual-nominal\n");
}

TEST(SheetMeaningOfACover, NumbersOfAWorkbookSeparateNoThousands) {
  const sheet::SheetToWrite table = {"X",
                                     {{"X [mm]", "Abw. X [um]"}, {"0", "1"}, {"1.125", "2"}, {"1000", "1"}}};
  EXPECT_EQ(read(sheet::workbook_of({table})), "X[mm],x[mm]\n0,0.001\n1.125,1.127\n1000,1000.001\n");
}

}  // namespace
}  // namespace vernier::sheet_meaning_test
