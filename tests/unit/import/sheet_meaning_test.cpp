// SPDX-License-Identifier: GPL-3.0-or-later
// Workshop tables with a value or a column that could mean two things: the other cells decide, or the message
// states what to do.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/unit/import/table_reading.h"
#include "tools/import/columns/doubled.h"
#include "tools/import/reading/sheet_import.h"
#include "tools/import/tables/directions.h"
#include "tools/import/tables/thousands.h"
#include "tools/sheet/workbook_writer.h"

namespace vernier::sheet_meaning_test {

using namespace vernier::importer;
using testing::AllOf;
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
    // A factor beside the unit.
    {"TheFactorOfATitle", "Abweichung in 1/1000 mm\nX [mm];hin;zurück\n0;1;2\n100;3;4\n200;2;1\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n100,1,1,100.003\n"},
    {"TheDecimalFactorOfATitle", "Abweichung in 0,01 mm\nX [mm];hin;zurück\n0;1;2\n100;3;4\n200;2;1\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.01\n100,1,1,100.03\n"},
    {"AnUnknownFactorOfATitle", "Abweichung in 0,002 mm\nX [mm];hin;zurück\n0;1;2\n100;3;4\n200;2;1\n",
     "refused: s.csv:2: \"hin to zurück\": the unit [0,002 mm] has a factor that is not known; convert the "
     "values"},
    {"AnUnknownFactorOfTheRuns", "X [mm];hin [0,5 um];zurück [0,5 um]\n0;1;2\n100;3;4\n200;2;1\n",
     "refused: s.csv:1: \"hin [0,5 um] to zurück [0,5 um]\": the unit [0,5 um] has a factor that is not "
     "known; convert the "
     "values"},
    {"TheUnitBelowAFactor", "Soll X;Abweichung X 1/100\nmm;mm\n0;1\n100;3\n200;2\n",
     "X[mm],x[mm]\n0,0.01\n100,100.03\n200,200.02\n"},
    {"TheUnitBelowAnotherUnit", "Soll X;Abweichung X Hundertstel\nmm;mm\n0;1\n100;3\n200;2\n",
     "refused: s.csv:2: \"mm\": the heading"},
    {"AMinusBehindTheNumber", "X [mm];dX [um]\n0;4,5-\n100;1,5\n200;2,5-\n",
     "X[mm],x[mm]\n0,-0.0045\n100,100.0015\n200,199.9975\n"},
    {"AFactorInBracketsWithOtherWords", "X [mm];dX (Messuhr 1/100) [mm]\n0;6\n100;7\n200;8\n",
     "refused: s.csv:1: \"dX (Messuhr 1/100) [mm]\": the unit ["},
    {"AFactorElsewhereInTheHeading", "X [mm];dX (1/100 Messuhr) [mm]\n0;6\n100;7\n200;8\n",
     "refused: s.csv:1: \"dX (1/100 Messuhr) [mm]\": half of the deviations are larger than 7 mm, and X "
     "moves "
     "by 200 mm: no machine has such errors; the heading has a factor that is not read"},
    {"AnUnknownFactor", "X [mm];Abweichung X 1/20 mm\n0;1\n100;3\n200;2\n",
     "refused: s.csv:1: \"Abweichung X 1/20 mm\": the unit [1/20 mm] has a factor that is not known; convert "
     "the values to a known unit, or, if they already are in one, state it in place of UNIT: --deviation "
     "\"X[UNIT]=Abweichung X 1/20 mm\"; known are mm um"},
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
     "X[mm],x[mm]\n100,99.9985\n200,199.998\nnote: the sign of the deviations is nominal - actual"},
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
     "X[mm],dirX,run,x[mm]\n0,-1,1,0.001\n-1,-1,1,-0.997\n-2,-1,1,-1.995\n-2,1,1,-1.994\n-1,1,1,-0.996\n0,1,"
     "1,0.002\nnote: \"hin [um]\" is read as the approach in the direction of decreasing positions"},
    {"UpOfAWideTableTowardSmallerPositions", "Z [mm];down [um];up [um]\n0;1;2\n-1;3;4\n-2;5;6\n",
     "Z[mm],dirZ,run,z[mm]\n0,-1,1,0.001\n"},
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
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n100,1,1,100.003\n100,-1,1,100.004\n0,-1,1,0.002\n"},
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
  EXPECT_THAT(
      read(table),
      HasSubstr("such as --column \"X[mm]=Position\" --deviation \"X[um]=Fehler vor to Fehler zurück\""));
  SheetWords words;
  words.columns = {"X[mm]=Position"};
  words.deviations = {"X[um]=Fehler vor to Fehler zurück"};
  const std::string by_headings = read(table, words);
  // The name in a profile, for any number of runs.
  words.deviations = {"X[um]=Deviation"};
  EXPECT_EQ(read(table, words), by_headings);
  EXPECT_EQ(read(table, words),
            "X[mm],dirX,run,x[mm]\n0,1,1,0.0012\n100,1,1,100.0022\n100,-1,1,100.0041\n0,-1,1,0.0034\n");
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

// Sizes of deviations that only a wrong unit explains.

TEST(SheetSize, ExchangedUnitsOfTwoHeadingsAreRefused) {
  const std::string table = "Soll X [um];Abw. X [mm]\n0;0,0\n100;3,2\n200;5,4\n300;9,1\n400;13,9\n";
  EXPECT_THAT(read(table),
              StartsWith("refused: s.csv:1: \"Abw. X [mm]\": the positions \"Soll X [um]\" are in "
                         "the smaller unit [um] and their deviations in [mm], so X would move by "
                         "0.4 mm only: the units of the two headings are probably exchanged"));
  SheetWords sure;
  sure.deviations = {"X[mm]=Abw. X [mm]"};
  EXPECT_THAT(read(table, sure), HasSubstr("400,14.3\nnote: "));
}

TEST(SheetSize, DeviationsThatNoMachineHasAreRefusedUnlessTheUserStatesTheUnit) {
  const std::string table = "Soll X [mm];Abw. X [mm]\n0;0,0\n100;3,2\n200;5,4\n300;9,1\n400;13,9\n";
  EXPECT_THAT(read(table),
              HasSubstr("half of the deviations are larger than 5.4 mm, and X moves by 400 mm: no "
                        "machine has such errors; if the unit [mm] is wrong, correct the unit in "
                        "the heading; if it is right, give --deviation \"X[mm]=Abw. X [mm]\""));
  SheetWords sure;
  sure.deviations = {"X[mm]=Abw. X [mm]"};
  EXPECT_THAT(read(table, sure), HasSubstr("400,413.9\nnote: \"Abw. X [mm]\": half of the deviations"));
}

TEST(SheetSize, AnUnusualDeviationIsNotedAndAUsualOneIsNot) {
  EXPECT_THAT(
      read("Soll X [mm];Abw. X [mm]\n0;1,0\n500;2,2\n1000;2,4\n"),
      HasSubstr("note: \"Abw. X [mm]\": the deviations are as large as 2.4 mm, and X moves by 1e+03 mm: "
                "unusual for a machine; if the unit [mm] is wrong"));
  EXPECT_THAT(read("Soll X [mm];Abw. X [um]\n0;1,0\n500;22\n1000;-400\n"), Not(HasSubstr("note")));
  EXPECT_THAT(read("Soll X [mm];Abw. X [um]\n0;0,001\n500;0,022\n1000;0,014\n"),
              HasSubstr("note: \"Abw. X [um]\": all deviations are below 0.1 um, less than an instrument"));
}

TEST(SheetSize, OneDeviationAThousandTimesAsLargeAsTheOtherOnesIsRefusedWithItsLine) {
  EXPECT_THAT(
      read("Soll X [mm];Abw. X [mm]\n0;0,000\n100;0,0032\n200;0,0054\n300;13,9\n400;0,0091\n"),
      StartsWith("refused: s.csv:5: \"Abw. X [mm]\": the deviation 13.9 mm in this row is more than 100 "
                 "times as large as the other ones (at most 9.1 um): correct the cell or its unit"));
}

TEST(SheetSize, ARunAndAColumnInAnotherUnitAreRefused) {
  EXPECT_THAT(
      read("Soll X [mm];Lauf 1 [um];Lauf 2 [um]\n0;1;0,001\n100;3,2;0,003\n200;5,4;0,006\n"),
      HasSubstr("the deviations of run 2 are about 3 nm, those of run 1 about 3.2 um: the two runs do "
                "not have the same unit"));
  SheetWords still;
  still.constants = {"Y[mm]=0"};
  EXPECT_THAT(
      read("X [mm];Abw. X [um];Abw. Y [um]\n0;1,0;0,0010\n100;3,2;0,0032\n200;5,4;0,0054\n", still),
      HasSubstr("\"Abw. Y [um]\": the deviations are about 3.2 nm, those of \"Abw. X [um]\" about 3.2 "
                "um: the two columns cannot both have the right unit"));
}

TEST(SheetSize, AMeasuredPositionFarFromItsTargetIsRefusedWithItsCell) {
  const auto table = [](const std::string& cell) {
    std::string text = "Soll X [mm];Ist X [mm]\n";
    for (int x = 0; x <= 900; x += 50)
      text += std::to_string(x) + ";" +
              (x == 450 ? cell : std::to_string(x) + ",00" + std::to_string(x % 7)) + "\n";
    return text;
  };
  EXPECT_THAT(read(table("450,012")), StartsWith("X[mm],x[mm]\n"));
  for (const auto& [cell, by] : {std::pair("405,012", "45 mm"), std::pair("4500,12", "4.05e+03 mm"),
                                 std::pair("451,012", "1.01 mm")}) {
    EXPECT_THAT(read(table(cell)),
                StartsWith(std::string("refused: s.csv:11: \"") + cell +
                           "\": the measured position \"Ist X [mm]\" differs from its target 450 by " + by +
                           " in this row, in the other rows by at most"));
    EXPECT_THAT(
        read(table(cell)),
        HasSubstr("correct the cell or its target; if both are right, give --column \"x[mm]=Ist X [mm]\""));
    SheetWords sure;
    sure.columns = {"x[mm]=Ist X [mm]"};
    EXPECT_THAT(read(table(cell), sure), AllOf(StartsWith("X[mm],x[mm]\n"), HasSubstr("note: line 11, \"")));
  }
}

TEST(SheetSize, AChangeOfTheSetUpAndATurnOfTheTableAreNoWrongCells) {
  // Half of the rows are in another set-up: their positions differ by the offset of the instrument.
  std::string offsets = "Soll X [mm];Ist X [mm]\n", turn = "C soll [deg];C ist [deg]\n";
  for (int x = 0; x <= 900; x += 50)
    offsets += std::to_string(x) + ";" + std::to_string(x + (x > 400 ? 7 : 0)) + ",002\n";
  for (int c = 0; c < 360; c += 30)
    turn += std::to_string(c) + ";" + (c == 0 ? "359,999" : std::to_string(c)) + "\n";
  EXPECT_THAT(read(offsets), StartsWith("X[mm],x[mm]\n"));
  EXPECT_THAT(read(turn), StartsWith("C[deg],rz[deg]\n"));
  // The point moves with the rotary axis too.
  EXPECT_THAT(read("X [mm];C [deg];x [mm]\n0;0;0\n100;0;100\n200;0;200\n300;0;300\n400;0;400\n500;0;500\n"
                   "600;0;600\n700;0;700\n800;0;800\n0;90;-30\n"),
              StartsWith("X[mm],C[deg],x[mm]\n"));
}

TEST(SheetSize, OneOptionAcceptsTheDeviationsOfAllColumnsOfARobot) {
  std::string table = "X [mm];Y [mm];dX [mm];dY [mm]\n";
  for (int i = 0; i < 8; ++i)
    table += std::to_string(800 + 50 * i) + ";" + std::to_string(37 * i * i % 500) + ";" +
             std::to_string(6 + i % 3) + "," + std::to_string(i) + ";" + std::to_string(-7 - i % 4) + ",5\n";
  EXPECT_THAT(read(table), HasSubstr("(for all columns of this machine: --deviation 20mm)"));
  SheetWords words;
  words.deviations = {"20mm"};
  EXPECT_THAT(read(table, words), AllOf(StartsWith("X[mm],Y[mm],x[mm],y[mm]\n"), Not(HasSubstr("note"))));
  words.deviations = {"5 mm"};
  EXPECT_THAT(read(table, words), HasSubstr("half of the deviations are larger than"));
  words.deviations = {"20"};
  EXPECT_THAT(read(table, words), HasSubstr("or a limit such as 20mm"));
  // With rotary joints, 6 mm are usual for a robot.
  std::string joints = "J1 [deg];J2 [deg];J3 [deg];X [mm];dX [mm]\n";
  for (int i = 0; i < 8; ++i)
    joints += std::to_string(10 * i) + ";" + std::to_string(-5 * i) + ";" + std::to_string(3 * i) + ";" +
              std::to_string(800 + 50 * i) + ";" + std::to_string(6 + i % 3) + ",5\n";
  EXPECT_THAT(read(joints), StartsWith("J1[deg],J2[deg],J3[deg],X[mm],x[mm]\n"));
}

TEST(SheetUnit, DivisionsOfADialGaugeAreUnits) {
  for (const std::string heading :
       {"Abw. X [1/100 mm]", "Abw. X [0,01 mm]", "Abw. X in 1/100 mm", "Abw. X 0,01 mm", "Abw. X Hundertstel",
        "Abw. X [Hundertstel mm]", "Abw. X (Teilstriche 0,01 mm)", "Abw. X Teilstriche 0,01 mm",
        "Abw. X 0.01 mm/div", "Abw. X/0.01 mm"})
    EXPECT_EQ(read("Soll X [mm];" + heading + "\n0;0\n100;3\n200;5,5\n"),
              "X[mm],x[mm]\n0,0\n100,100.03\n200,200.055\nnote: \"" + heading +
                  "\": one unit is 0.01 mm (10 um)\n");
  EXPECT_EQ(read("Soll X [mm];Abw. X [1/1000 mm]\n0;0\n100;3\n"), "X[mm],x[mm]\n0,0\n100,100.003\n");
  EXPECT_EQ(read("Soll X [mm];Error X [0.001 in]\n0;0\n100;1\n"), "X[mm],x[mm]\n0,0\n100,100.0254\n");
  EXPECT_THAT(
      read("Soll X [mm];Error X [tenths]\n0;0\n100;1\n"),
      StartsWith("X[mm],x[mm]\n0,0\n100,100.00254\nnote: \"Error X [tenths]\": one unit is 0.0001 inch"));
  for (const std::string unit : {"0.01mm", "0,01 mm", "1/100 mm", "Hundertstel", "Teilstriche 0,01 mm"}) {
    SheetWords words;
    words.unit = unit;
    EXPECT_THAT(read("Soll X [mm];Abw. X\n0;0\n100;3\n", words), HasSubstr("\n100,100.03\n")) << unit;
  }
}

TEST(SheetUnit, AnUnknownUnitHasAnOptionThatReadsIt) {
  const std::string table = "Soll X [mm];Abw. X [Skt]\n0;0\n100;3\n";
  EXPECT_THAT(
      read(table),
      AllOf(HasSubstr("state it in place of UNIT: --deviation \"X[UNIT]=Abw. X [Skt]\"; known are mm"),
            Not(HasSubstr("X[0.01mm]"))));
  SheetWords words;
  words.deviations = {"X[0.01mm]=Abw. X [Skt]"};
  EXPECT_THAT(read(table, words), StartsWith("X[mm],x[mm]\n0,0\n100,100.03\n"));
  SheetWords all;  // a unit for the headings without one
  all.unit = "mm";
  EXPECT_THAT(read(table, all), HasSubstr("has a factor that is not known"));
}

TEST(SheetUnit, SizesOfRotaryAxesAreJudgedAsThoseOfLinearAxes) {
  const auto table = [](const std::string& headings, const std::string& third) {
    return headings + "\n0;2\n30;3\n60;4\n90;" + third + "\n120;1\n150;2\n";
  };
  EXPECT_THAT(read(table("C [deg];dC [arcsec]", "2")), StartsWith("C[deg],rz["));
  EXPECT_THAT(read(table("C [deg];dC [deg]", "2")),
              HasSubstr("refused: s.csv:1: \"dC [deg]\": half of the deviations are larger than 2 deg"));
  EXPECT_THAT(read(table("C [arcsec];dC [deg]", "2")), HasSubstr("are probably exchanged"));
  EXPECT_THAT(read(table("C [deg];dC [arcsec]", "2000")),
              HasSubstr("refused: s.csv:5: \"dC [arcsec]\": the deviation 0.556 deg in this row is more than "
                        "100 times as large as the other ones"));
}

TEST(SheetUnit, DegreesUnderRadAndRadiansUnderDegAreRefused) {
  const std::string degrees = "C [rad];dC [arcsec]\n0;1\n90;2\n180;3\n270;2\n360;1\n";
  EXPECT_THAT(read(degrees),
              StartsWith("refused: s.csv:1: \"C [rad]\": the positions go to 360, 57.3 turns in "
                         "rad: degrees under a heading in rad; correct the unit of the heading "
                         "to [deg]; if [rad] is right, give --column \"C[rad]=C [rad]\""));
  const std::string few = "C [rad];dC [arcsec]\n0;1\n3;2\n6;3\n9;2\n";
  EXPECT_THAT(read(few), HasSubstr("the positions go to 9, and all are whole numbers: degrees"));
  SheetWords sure;
  sure.columns = {"C[rad]=C [rad]"};
  EXPECT_THAT(read(few, sure), StartsWith("C[rad],rz[deg]\n"));
  const std::string radians = "C [deg];dC [arcsec]\n0;1\n0,524;2\n1,047;3\n1,571;2\n2,094;1\n6,283;1\n";
  EXPECT_THAT(
      read(radians),
      HasSubstr("the positions go to 6.283, and all are fractions of a half turn in rad: radians under a "
                "heading in deg; correct the unit of the heading to [rad]"));
  EXPECT_THAT(read("C [deg];dC [arcsec]\n0;1\n0,5;2\n1;3\n1,5;2\n2;1\n6;1\n"), StartsWith("C[deg],"));
  EXPECT_THAT(read("C [rad];dC [arcsec]\n0;1\n1,5708;2\n3,1416;3\n4,7124;2\n6,2832;1\n"),
              StartsWith("C[rad],"));
}

/// Zeros at the end of all cells, a zero of the table that is no zero of the axis, and the joints of a robot.
TEST(SheetUnit, RadiansUnderDegFromAnotherZeroAreRefusedAndThoseOfARobotNoted) {
  EXPECT_THAT(read("C [deg];dC [arcsec]\n0,0000;1\n0,5240;2\n1,0470;3\n1,5710;2\n2,0940;1\n2,6180;1\n"),
              HasSubstr("and all are fractions of a half turn in rad: radians under a heading in deg"));
  const std::string moved =
      "Soll C [deg];Ist C [deg]\n0,0500;0,0500\n0,2245;0,2245\n0,3991;0,3991\n0,5736;0,5735\n"
      "0,7481;0,7481\n0,9227;0,9227\n1,0972;1,0972\n";
  EXPECT_THAT(read(moved),
              HasSubstr("refused: s.csv:1: \"Soll C [deg]\": the positions go to 1.0972, and all "
                        "differ from 0.05 by fractions of a half turn in rad: radians under a "
                        "heading in deg; correct the unit of the heading to [rad]"));
  SheetWords sure;
  sure.columns = {"C[deg]=Soll C [deg]", "rz[deg]=Ist C [deg]"};
  EXPECT_THAT(read(moved, sure), StartsWith("C[deg],rz[deg]\n"));
  EXPECT_THAT(read("C [deg];dC [arcsec]\n-2,900;1\n-2,376;2\n-1,853;3\n-1,329;2\n-0,806;1\n-0,282;1\n"
                   "0,242;1\n0,765;1\n"),
              HasSubstr("differ from -2.9 by fractions"));
  // Degrees of a small table, from any zero, are degrees.
  for (const char* const right :
       {"C [deg];dC [arcsec]\n0,00;1\n0,25;2\n0,50;3\n0,75;2\n1,00;1\n1,25;1\n1,50;1\n",
        "C [deg];dC [arcsec]\n-3,000;1\n-2,500;2\n-2,000;3\n-1,500;2\n-1,000;1\n-0,500;1\n0,000;1\n",
        "C [deg];dC [arcsec]\n0,1234;1\n0,6234;2\n1,1234;3\n1,6234;2\n2,1234;1\n2,6234;1\n3,1234;1\n"})
    EXPECT_THAT(read(right), AllOf(StartsWith("C[deg],rz[deg]\n"), Not(HasSubstr("rad")))) << right;
  std::string joints = "J1 [deg];J2 [deg];J3 [deg];x [mm];y [mm];z [mm]\n", degrees = joints;
  for (int i = 0; i < 8; ++i) {
    joints += fmt::format("{:.4f};{:.4f};{:.4f};{};{};{}\n", 0.3 * i - 1.1, 1.7 - 0.4 * i, 0.35 * i - 1.4,
                          100 * i, 50 * i, 400 - 40 * i);
    degrees += fmt::format("{};{};{};{};{};{}\n", 20 * i - 60, 90 - 25 * i, 18 * i - 70, 100 * i, 50 * i,
                           400 - 40 * i);
  }
  EXPECT_THAT(read(joints),
              HasSubstr("note: the positions of 3 rotary axes are between -3.14 and 3.14 deg: if "
                        "they are in radians, correct the units of their headings to [rad]"));
  EXPECT_THAT(read(degrees), Not(HasSubstr("radians")));
}

/// Positions of 0 to 500 under [um]: a machine of half a millimetre was read without a word.
TEST(SheetUnit, PositionsInMillimetresUnderMicrometresAreRefused) {
  const std::string rows = "0;0,5\n100;7,2\n200;8,5\n300;8,7\n400;9,0\n500;12,7\n";
  EXPECT_THAT(
      read("X [um];Abweichung X [um]\n" + rows),
      StartsWith("refused: s.csv:1: \"X [um]\": the positions go from 0 to 500 um, so X would move by "
                 "0.5 mm only, with deviations of 8.7 um; if the positions are in mm, correct the unit "
                 "of the heading to [mm]; if [um] is right, give --column \"X[um]=X [um]\""));
  SheetWords sure;
  sure.columns = {"X[um]=X [um]"};
  EXPECT_THAT(read("X [um];Abweichung X [um]\n" + rows, sure), StartsWith("X[um],x[mm]\n"));
  EXPECT_THAT(read("Soll X [um];Ist X [um]\n0;0,5\n100;107,2\n200;208,5\n300;308,7\n400;409,0\n500;512,7\n"),
              StartsWith("refused: s.csv:1: \"Soll X [um]\": the positions go from 0 to 500 um"));
  EXPECT_THAT(read("X [um];dX [um]\n0;0\n20;1,6\n40;3,2\n60;4,8\n80;6,4\n100;8\n"),
              StartsWith("X[um],x[mm]\n"));
  // A piezo stage is read, with a note; a long motion in um without one.
  EXPECT_THAT(
      read("X [um];Abweichung X [nm]\n" + rows),
      AllOf(StartsWith("X[um],x[mm]\n"), HasSubstr("note: \"X [um]\": the positions go from 0 to 500 um")));
  EXPECT_THAT(read("X [um];Abweichung X [um]\n0;0,5\n100000;7,2\n200000;8,5\n300000;8,7\n400000;9,0\n"),
              AllOf(StartsWith("X[um],x[mm]\n"), Not(HasSubstr("would move"))));
}

/// A column that slipped by one row against its targets.
TEST(SheetShift, MeasuredPositionsOfTheNextRowAreRefused) {
  const std::string h = "Soll X [mm];Ist X [mm]\n";
  const std::string next =
      h +
      "0;50,004\n50;100,007\n100;150,008\n150;150,013\n150;100,012\n100;50,010\n50;0,006\n"
      "0;0,001\n";
  EXPECT_THAT(
      read(next),
      StartsWith("refused: s.csv:1: \"Ist X [mm]\": the measured positions agree with the targets of the "
                 "row below them"));
  EXPECT_THAT(read(next),
              HasSubstr("the column is probably shifted by one row against the targets; move the "
                        "column by one row; if the rows are right, give --column \"x[mm]=Ist X [mm]\""));
  SheetWords sure;
  sure.columns = {"x[mm]=Ist X [mm]"};
  EXPECT_THAT(read(next, sure),
              AllOf(StartsWith("X[mm],x[mm]\n"), HasSubstr("note: \"Ist X [mm]\": the measured")));
  // One step in all rows may be the zero of the instrument; another distance is that zero.
  const auto moved = [&](double by) {
    std::string rows = h;
    for (int x = 0; x <= 300; x += 50) rows += fmt::format("{};{:.3f}\n", x, x + by + 0.00002 * x);
    return read(rows);
  };
  EXPECT_THAT(moved(50), HasSubstr("or the zero of the instrument is one step away"));
  EXPECT_THAT(moved(1250.3), Not(HasSubstr("shifted")));
  EXPECT_THAT(moved(0), Not(HasSubstr("shifted")));
}

TEST(SheetShift, AnEmptyFirstReadingIsNotedAndOneBelowTheTableIsRefusedWithTheCause) {
  const std::string h = "X [mm];Abweichung X [um]\n0;\n50;0,5\n100;4,4\n150;7,2\n200;8\n";
  EXPECT_THAT(read(h),
              HasSubstr("note: \"Abweichung X [um]\" is empty in line 2 only, the first row: if the column "
                        "is shifted by one row against the positions, move it"));
  EXPECT_THAT(read(h + ";8,5\n"),
              HasSubstr("if the deviations are shifted by one row against the positions, move their column"));
  // One of several runs side by side.
  EXPECT_THAT(read("X [mm];hin [um];rueck [um]\n0;1;\n50;2;6,5\n100;3;7\n150;4;8\n200;5;9\n"),
              HasSubstr("(column 3) is empty in line 2 only, the first row: if the column is shifted"));
  // A lost reading in the middle is only lost.
  EXPECT_THAT(read("X [mm];Abweichung X [um]\n0;1\n50;\n100;4,4\n150;7,2\n200;8\n"),
              Not(HasSubstr("shifted")));
}

TEST(SheetUnit, OneDirectionInAnotherUnitIsRefused) {
  const std::string unlike =
                        "X [mm];Richtung;dX [um]\n0;+;2\n1;+;3\n2;+;4\n2;-;0.002\n1;-;0.003\n0;-;0.004\n",
                    zero = "X [mm];Richtung;dX [um]\n0;+;2\n1;+;3\n2;+;4\n2;-;0\n1;-;0\n0;-;0\n";
  EXPECT_THAT(read(unlike), HasSubstr("the two directions do not have the same unit"));
  EXPECT_THAT(read(zero), StartsWith("X[mm],dirX,x[mm]\n"));
  EXPECT_THAT(read("X [mm];+ [um];- [um]\n0;2;0.002\n1;3;0.003\n2;4;0.004\n"),
              HasSubstr("the two directions do not have the same unit"));
}

// Directions that the order of the rows contradicts.

TEST(SheetDirection, SignsAgainstTheOrderOfTheRowsAreRefusedUnlessTheUserAssignsThem) {
  for (const auto& [up, down] : {std::pair("+", "-"), std::pair("up", "down"), std::pair("1", "-1")}) {
    std::string table = "Soll X [mm];Abw. X [um];Richtung\n";
    for (const int x : {200, 100, 0}) table += std::to_string(x) + ";1;" + up + "\n";
    for (const int x : {0, 100, 200}) table += std::to_string(x) + ";2;" + down + "\n";
    EXPECT_THAT(read(table),
                HasSubstr("contradict the order of the rows: the positions of X decrease from row to "
                          "row in the direction + (up); exchange the two directions in the file, or "
                          "leave the column out (--leave \"Richtung\")"));
    SheetWords given, left;
    given.columns = {"dirX=Richtung"};
    EXPECT_THAT(read(table, given), StartsWith("X[mm],x[mm],dirX\n200,200.001,1\n"));
    EXPECT_THAT(read(table, given), HasSubstr("note: \"Richtung\": the directions ("));
    left.left = {"Richtung"};
    EXPECT_THAT(read(table, left), StartsWith("X[mm],x[mm]\n200,200.001\n"));
  }
}

TEST(SheetDirection, SomeRunsWithExchangedDirectionsAreRefusedUnlessTheUserAssignsThem) {
  for (const auto& [up, down] : {std::pair("+", "-"), std::pair("hin", "zurück"), std::pair("v", "r")}) {
    std::string table = "Lauf;Soll X [mm];Abw. X [um];Richtung\n";
    for (int run = 1; run <= 5; ++run) {
      const bool exchanged = run == 2 || run == 3 || run == 5;  // three of five
      for (const int x : {0, 100, 200, 300})
        table += std::to_string(run) + ";" + std::to_string(x) + ";1;" + (exchanged ? down : up) + "\n";
      for (const int x : {300, 200, 100, 0})
        table += std::to_string(run) + ";" + std::to_string(x) + ";2;" + (exchanged ? up : down) + "\n";
    }
    EXPECT_THAT(read(table),
                HasSubstr("refused: s.csv:10: \"Richtung\": the directions contradict the order of "
                          "the rows in 6 of 10 runs, first in line 10"));
    SheetWords given;
    given.columns = {"dirX=Richtung"};
    EXPECT_THAT(read(table, given), HasSubstr("note: \"Richtung\": the directions contradict"));
  }
}

TEST(SheetDirection, ATableSortedByThePositionShowsNoDirection) {
  EXPECT_THAT(read("X [mm];Abw. X [um];Richtung\n0;1;+\n1;1;+\n2;1;+\n0;2;-\n1;2;-\n2;2;-\n"),
              Not(HasSubstr("contradict")));
  EXPECT_THAT(read("X[mm],x[mm],dirX\n2,2,1\n1,1,1\n0,0,1\n0,0,-1\n1,1,-1\n2,2,-1\n"),
              HasSubstr("note: \"dirX\": the directions (-1, 1) contradict the order of the rows"));
}

TEST(SheetDirection, UpInAHeadingOfATableWithDecreasingPositionsIsNoted) {
  EXPECT_THAT(
      read("Soll Z [mm];up [um];down [um]\n0;1;2\n-1;3;4\n-2;5;6\n"),
      HasSubstr("note: \"up [um]\" is read as the approach in the direction of increasing positions"));
}

TEST(SheetDirection, OneDirectionInAllRowsOfAMotionOutAndBackIsRefusedUnlessTheUserAssignsIt) {
  const std::string table =
      "Soll X [mm];Abw. X "
      "[um];Richtung\n0;1;+\n100;2;+\n200;3;+\n300;4;+\n300;7;+\n200;6;+\n100;5;+\n0;4;+\n";
  EXPECT_THAT(read(table),
              StartsWith("refused: s.csv:7: \"Richtung\": all rows have the same direction (+), and the "
                         "positions of X go the other way in lines 7, 8, 9; correct the directions in these "
                         "rows, or leave the column out (--leave \"Richtung\")"));
  SheetWords given;
  given.columns = {"dirX=Richtung"};
  EXPECT_THAT(read(table, given), AllOf(StartsWith("X[mm],x[mm],dirX\n0,0.001,1\n"),
                                        HasSubstr("note: \"Richtung\": all rows have the same direction")));
  // Each run goes out alone; a second axis moves: each row may be approached from one side.
  EXPECT_THAT(read("Lauf;X [mm];dX [um];Richtung\n1;0;1;+\n1;1;2;+\n1;2;3;+\n2;0;1;+\n2;1;2;+\n2;2;3;+\n"),
              Not(HasSubstr("direction")));
  EXPECT_THAT(
      read("X [mm];Y [mm];dX [um];Richtung X\n0;0;1;+\n1;0;2;+\n2;0;3;+\n2;9;3;+\n1;9;2;+\n0;9;1;+\n"),
      HasSubstr("note: \"Richtung X\": all rows have the same direction (+), and the positions of X go the "
                "other way in lines 6, 7; the directions are used as written"));
}

TEST(SheetDirection, AChangeMarkedSomeRowsBesideTheTurnIsRefusedWithTheRows) {
  const auto table = [](int first_back) {
    std::string text = "Soll X [mm];Abw. X [um];Richtung\n";
    int row = 0;
    for (const int x : {0, 100, 200, 300, 400, 500, 500, 400, 300, 200, 100, 0})
      text += std::to_string(x) + ";1;" + (row++ < first_back ? "+" : "-") + "\n";
    return text;
  };
  EXPECT_THAT(read(table(6)), StartsWith("X[mm],x[mm],dirX\n"));
  EXPECT_THAT(read(table(6)), Not(HasSubstr("note")));
  EXPECT_THAT(read(table(4)),
              StartsWith("refused: s.csv:6: \"Richtung\": the direction changes at another row than the "
                         "motion, and the positions of X go the other way in lines 6, 7; correct"));
  EXPECT_THAT(read(table(9)), HasSubstr("go the other way in lines 9, 10; correct"));
  // The machine may have moved beyond the end before the one row at the turn.
  EXPECT_THAT(read(table(5)), StartsWith("X[mm],x[mm],dirX\n"));
}

// Forms of cells.

TEST(SheetCells, ALineBreakInAQuotedHeadingIsABlank) {
  EXPECT_EQ(read("\"Soll X\n[mm]\";\"Abw. X\r\n[um]\"\n0;1,5\n100;3,2\n"),
            "X[mm],x[mm]\n0,0.0015\n100,100.0032\n");
  EXPECT_THAT(read("\"Soll X\n[mm]\";\"Abw. X [um]\"\n0;1,5\n100;a\n"), HasSubstr("s.csv:4: \"a\""));
  EXPECT_THAT(read("\"Soll X [mm];Abw. X [um]\n0;1,5\n100;3\n"), HasSubstr("a closing quote is missing"));
}

TEST(SheetCells, NumbersInBracketsAreNegative) {
  EXPECT_EQ(read("Soll X [mm];Abw. X [um]\n0;(1,5)\n100;3\n200;(12)\n"),
            "X[mm],x[mm]\n0,-0.0015\n100,100.003\n200,199.988\nnote: 2 cells such as \"(1,5)\" are read as "
            "negative numbers (accounting format)\n");
}

TEST(SheetCells, AColumnWhollyInBracketsIsNegative) {
  EXPECT_EQ(read("Soll X [mm];Abw. X [um]\n0;(1,5)\n100;(3)\n200;(12,5)\n"),
            "X[mm],x[mm]\n0,-0.0015\n100,99.997\n200,199.9875\nnote: 3 cells such as \"(1,5)\" are read as "
            "negative numbers (accounting format)\n");
  EXPECT_THAT(read("Soll Z [mm];Ist Z [mm]\n0;0,0010\n(50);(50,0123)\n(100);(100)\n"),
              StartsWith("Z[mm],z[mm]\n0,0.0010\n-50,-50.0123\n-100,-100\n"));
  EXPECT_THAT(read("Soll Z [mm];Ist Z [mm]\n(50);(50,0123)\n(100);(100,002)\n"),
              StartsWith("Z[mm],z[mm]\n-50,-50.0123\n-100,-100.002\n"));
  // Whole numbers in brackets alone number the rows.
  EXPECT_THAT(read("Nr;Soll X [mm];Abw. X [um]\n(1);0;1,5\n(2);100;3\n(3);200;2\n"),
              Not(HasSubstr("negative")));
}

TEST(SheetCells, BlanksSeparateColumnsWithDecimalCommas) {
  EXPECT_EQ(read("Soll X [mm]   Abw. X [mm]\n  0,0000    0,0012\n100,0000   -0,0032\n200,0000    0,0040\n"),
            "X[mm],x[mm]\n0.0000,0.0012\n100.0000,99.9968\n200.0000,200.004\n");
  EXPECT_EQ(read("X [mm],x [mm]\n0,0.001\n100,100.002\n"), "X[mm],x[mm]\n0,0.001\n100,100.002\n");
  // A title of several words is one cell.
  EXPECT_THAT(
      read("Deviations in um\nX [mm]     Run 1 fwd   Run 1 rev\n0        0.1      -3.0\n100      1.1      "
           "-2.0\n"),
      StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.0001\n100,1,1,100.0011\n100,-1,1,99.998\n"));
}

TEST(SheetCells, ATitleStatesTheUnitOfTheDeviations) {
  const std::string rows = "Soll X [mm];Abweichung X\n0;1,5\n100;-2\n200;3\n";
  const std::string values = "X[mm],x[mm]\n0,0.0015\n100,99.998\n200,200.003\n";
  EXPECT_EQ(read("Abweichungen in \u00b5m;\n" + rows),
            values +
                "note: the unit of the deviations is [um], by the title \"Abweichungen in \u00b5m\"; if this "
                "is wrong, give --unit\n");
  EXPECT_THAT(read("Positionen in mm, Abweichungen in \u00b5m;\n" + rows), StartsWith(values));
  // The unit belongs to the positions, or two titles contradict each other.
  EXPECT_THAT(read("Abweichungen an den Positionen in mm;\n" + rows), HasSubstr("no unit"));
  EXPECT_THAT(read("Abweichungen in \u00b5m;\nAbweichung in mm;\n" + rows), HasSubstr("no unit"));
}

TEST(SheetCells, AUnitOfATitleBelongsToTheQuantityBeforeIt) {
  const std::string runs = "Pos [mm];1+;1-\n0;1,5;2\n100;-2;3\n";
  const auto last = [](const std::string& unit) {
    return unit == "um"
               ? "X[mm],dirX,run,x[mm]\n0,1,1,0.0015\n100,1,1,99.998\n100,-1,1,100.003\n0,-1,1,0.002\n"
               : "X[mm],dirX,run,x[mm]\n0,1,1,1.5\n100,1,1,98\n100,-1,1,103\n0,-1,1,2\n";
  };
  for (const char* const title :
       {"Achse X: Positionen in mm, Abweichungen in \u00b5m",
        "Achse X, Sollwerte in mm, Abweichungen in \u00b5m",
        "Achse X: Position in mm / Abweichung in \u00b5m", "Achse X (Abweichung in \u00b5m)",
        "Toleranz 0,02 mm, Positionierabweichungen in \u00b5m, Achse X",
        "Achse X, Abweichungen, Werte in \u00b5m"})
    EXPECT_THAT(read(std::string(title) + ";;\n" + runs), StartsWith(last("um"))) << title;
  EXPECT_THAT(read("Achse X, Toleranz 8 \u00b5m, Abweichungen in mm;;\n" + runs), StartsWith(last("mm")));
  // The titles give the units of all columns.
  EXPECT_THAT(read("Achse X: Positionen in mm, Abweichungen in \u00b5m;;\nPos;1+;1-\n0;1,5;2\n100;-2;3\n"),
              StartsWith(last("um")));
  EXPECT_THAT(read("Achse X, alle Werte in mm\nSoll;Ist\n0;0,001\n100;100,002\n"),
              StartsWith("X[mm],x[mm]\n0,0.001\n100,100.002\n"));
}

TEST(SheetCells, WholeTurnsOfAMeasuredAngleAreRemoved) {
  EXPECT_EQ(
      read("Soll C [deg];Ist C [deg]\n0;359,9994\n90;90,0010\n180;180,0000\n270;269,9990\n"),
      "C[deg],rz[deg]\n0,-0.0006\n90,90.0010\n180,180.0000\n270,269.9990\n"
      "note: 1 measured positions of \"Ist C [deg]\" differ from their target by whole turns, which are "
      "removed (359.999 at 0 deg is read as -0.001)\n");
}

TEST(SheetCells, DirectionsOfAnAxisWithItsLetterAndInWordsOfAWay) {
  for (const auto& [forth, back] : {std::pair{"X+", "X-"}, {"Hinfahrt", "R\u00fcckfahrt"}})
    EXPECT_EQ(read(std::string("X soll [mm];Richtung;Abweichung [um]\n0;") + forth + ";1\n100;" + forth +
                   ";2\n100;" + back + ";3\n0;" + back + ";4\n"),
              "X[mm],dirX,x[mm]\n0,1,0.001\n100,1,100.002\n100,-1,100.003\n0,-1,0.004\n");
}

TEST(SheetCells, AMotionOutAndBackWithoutDirectionsIsSaid) {
  const std::string rows = "X [mm];Abweichung X [um]\n0;1\n100;2\n200;3\n200;7\n100;6\n0;5\n";
  EXPECT_THAT(read(rows),
              HasSubstr("note: the rows go out and back along X (back in lines 6, 7), and no column states "
                        "the approach direction"));
  EXPECT_THAT(read("X [mm];dirX;Abweichung X [um]\n0;1;1\n100;1;2\n200;1;3\n200;-1;7\n100;-1;6\n0;-1;5\n"),
              Not(HasSubstr("out and back")));
  // A second run in the same direction, and the lines of a grid.
  EXPECT_THAT(read("X [mm];Abweichung X [um]\n0;1\n100;2\n200;3\n0;1\n100;2\n200;3\n"),
              Not(HasSubstr("out and back")));
  EXPECT_THAT(read("X [mm];Y [mm];Abweichung X [um]\n0;0;1\n100;0;2\n200;0;3\n200;9;1\n100;9;2\n0;9;3\n"),
              Not(HasSubstr("out and back")));
}

TEST(SheetCells, NumbersOfRunsAboveALineOfUnitsAreHeadings) {
  EXPECT_THAT(read("Pos. X [mm];1;2\nmm;um;um\n0;1;2\n50;3;4\n"),
              StartsWith("X[mm],run,x[mm]\n0,1,0.001\n50,1,50.003\n0,2,0.002\n50,2,50.004\n"));
}

TEST(SheetRemedy, ADeviationWithoutAPositionNamesTheOptionThatReadsIt) {
  struct Remedy {
    const char *table, *option, *deviation, *constant, *read;
  };
  for (const Remedy& one :
       {Remedy{"Nr;Abw. X [um]\n1;1\n2;2\n", "--set \"X[mm]=0\"", "", "X[mm]=0", ",0.001,0\n"},
        Remedy{"X [mm];Abw. B [arcsec]\n1;1\n2;2\n", "--set \"B[deg]=0\"", "", "B[deg]=0",
               "1,0.000277778,0\n"},
        Remedy{"Nr;Abweichung [um]\n1;1\n2;2\n", "--deviation \"X=Abweichung [um]\" --set \"X[mm]=0\"",
               "X=Abweichung [um]", "X[mm]=0", ",0.001,0\n"},
        Remedy{"U [mm];Abw. U [um]\n1;1\n2;2\n", "--deviation \"X=Abw. U [um]\" --set \"X[mm]=0\"",
               "X=Abw. U [um]", "X[mm]=0", "1,0.001,0\n"}}) {
    EXPECT_THAT(read(one.table), AllOf(StartsWith("refused: "), HasSubstr(one.option)));
    SheetWords words;
    if (*one.deviation != '\0') words.deviations = {one.deviation};
    words.constants = {one.constant};
    EXPECT_THAT(read(one.table, words), HasSubstr(one.read));
  }
}

}  // namespace
}  // namespace vernier::sheet_meaning_test
