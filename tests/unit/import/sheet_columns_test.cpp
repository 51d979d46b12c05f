// SPDX-License-Identifier: GPL-3.0-or-later
// Spreadsheets as people send them: each is read rightly, or refused with the mend.
#include "tools/import/columns/sheet_columns.h"

#include <gtest/gtest.h>

#include <functional>

#include "tools/import/reading/sheet_import.h"
#include "tools/import/tables/computed_rows.h"
#include "tools/import/tables/sheet_table.h"
#include "tools/import/tables/wide_sheet.h"
#include "tools/sheet/several_tables.h"
#include "tools/text/files.h"

namespace vernier::sheet_columns_test {

using namespace vernier::importer;
using namespace vernier::sheet;
using namespace vernier::text;
namespace {

std::string import(const std::string& bytes, SheetWishes wishes = {},
                   const std::function<void(SheetWishes&, const SheetTable&)>& say = {}) {
  try {
    Sheet sheet = read_sheet(bytes, "s.csv", wishes.format);
    keep_table(sheet, wishes.format.table);
    SheetTable table = parts_of_sheet(sheet);
    note_short_rows(sheet, table);
    leave_computed_rows(sheet, table);
    unfold_runs(sheet, table, wishes);
    if (say) say(wishes, table);
    return measurement_csv(table_of_sheet(sheet, table, columns_of_sheet(sheet, table, wishes), wishes));
  } catch (const InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

void add_constant_to(SheetWishes& wishes, const std::string& words) {
  ColumnMap map;
  add_constant(map, words);
  wishes.constants.insert(wishes.constants.end(), map.columns.begin(), map.columns.end());
}

std::string utf16(const std::string& ascii, bool mark) {
  std::string text = mark ? "\xFF\xFE" : "";
  for (const char c : ascii) text += std::string{c, '\0'};
  return text;
}

struct Case {
  const char* name;
  std::string bytes;
  const char* read;  // the measurement file, or a part of the refusal behind "refused"
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

const Case kCases[] = {
    {"PlainCsv", "X[mm],x[mm]\n1,2\n", "X[mm],x[mm]\n1,2\n"},
    {"ComponentErrorsOfAnAxis",
     "X[mm],Y[mm],Z[mm],EXX[um],EYX[um],EZX[um],EAX[arcsec],EBX[arcsec],ECX[arcsec]\n100,5,7,1,2,3,4,5,6\n",
     "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],rx[arcsec],ry[arcsec],rz[arcsec]\n100,5,7,100.001,5.002,7.003,4,5,"
     "6\n"},
    {"StraightnessAndPitchAreNoInputs",
     "Target X [mm],Error (um),Vertical straightness (um),Pitch (arcsec)\n100,1,2,3\n",
     "X[mm],x[mm]\n100,100.001\n"},
    {"Semicolons", "X[mm];x[mm]\n1;2.5\n", "X[mm],x[mm]\n1,2.5\n"},
    {"DecimalComma", "X[mm];x[mm]\n1;2,5\n", "X[mm],x[mm]\n1,2.5\n"},
    {"Tabs", "X[mm]\tx[mm]\n1\t2,5\n", "X[mm],x[mm]\n1,2.5\n"},
    {"Blanks", "X[mm] x[mm]\n1   2.5\n", "X[mm],x[mm]\n1,2.5\n"},
    {"ByteOrderMark", "\xEF\xBB\xBFX[mm];x[mm]\n1;2\n", "X[mm],x[mm]\n1,2\n"},
    {"Utf16", utf16("X[mm]\tx[mm]\r\n1\t2,5\r\n", true), "X[mm],x[mm]\n1,2.5\n"},
    {"Utf16WithoutMark", utf16("X[mm];x[mm]\n1;2\n", false), "X[mm],x[mm]\n1,2\n"},
    {"OldCodePage",
     "X[mm];x[\xB5m];T[\xB0"
     "C]\n1;2,5;20,1\n",
     "X[mm],x[um],T[degC]\n1,2.5,20.1\n"},
    {"Parentheses", "X(mm);x (µm)\n1;2\n", "X[mm],x[um]\n1,2\n"},
    {"RowOfUnits", "X;x;Temp\n[mm];[µm];[°C]\n1;2;3\n", "X[mm],x[um],Temp[degC]\n1,2,3\n"},
    {"TitleLines", "Messung Portal 4;;\n12.03.2026;;\nX[mm];x[mm];\n1;2;\n", "X[mm],x[mm]\n1,2\n"},
    {"TrailingSemicolons", "X[mm];x[mm];;;\n1;2;;;\n", "X[mm],x[mm]\n1,2\n"},
    {"EmptyRows", "X[mm];x[mm]\n1;2\n;\n\n2;3\n;\n", "X[mm],x[mm]\n1,2\n2,3\n"},
    {"ExcelsFirstLine", "sep=;\nX[mm];x[mm]\n1;2\n", "X[mm],x[mm]\n1,2\n"},
    {"MacLineEnds", "X[mm];x[mm]\r1;2\r2;3\r", "X[mm],x[mm]\n1,2\n2,3\n"},
    {"Thousands", "X[mm];x[mm]\n1.000,5;1.000,75\n", "X[mm],x[mm]\n1000.5,1000.75\n"},
    {"LongMinus",
     "X[mm];x[mm]\n1;\u2212"
     "0,5\n",
     "X[mm],x[mm]\n1,-0.5\n"},
    {"TargetAndActual", "X soll [mm];X ist [mm]\n1;1,5\n", "X[mm],x[mm]\n1,1.5\n"},
    {"TargetAndDeviation", "X target (mm);Deviation (µm)\n100;-1.5\n", "X[mm],x[mm]\n100,99.9985\n"},
    {"SensesOfTwoAxes", "X[mm];Y[mm];x[mm];Richtung X;Richtung Y\n1;5;1;+;-\n2;6;2;-;+\n",
     "X[mm],Y[mm],x[mm],dirX,dirY\n1,5,1,1,-1\n2,6,2,-1,1\n"},
    {"SensesInWords", "X[mm];x[mm];Richtung;Lauf\n1;2;hin;1\n1;2;zurück;1\n",
     "X[mm],x[mm],dirX,run\n1,2,1,1\n1,2,-1,1\n"},
    {"SensesInUnknownWords", "X[mm];x[mm];Richtung\n1;2;li\n1;2;re\n",
     "refused: s.csv:2: \"li\": not an approach direction, for dirX: write + or -"},
    {"SensesCountedOneAndNought", "X[mm];x[mm];Direction\n1;2;1\n1;2;0\n",
     "X[mm],x[mm],dirX\n1,2,1\n1,2,-1\n"},
    {"SensesCountedOneAndTwo", "X[mm];x[mm];Richtg.\n1;2;1\n1;2;2\n", "X[mm],x[mm],dirX\n1,2,1\n1,2,-1\n"},
    {"SensesOfTheFormatStay", "X[mm];x[mm];dirX\n1;2;1\n1;2;0\n", "X[mm],x[mm],dirX\n1,2,1\n1,2,0\n"},
    {"SignsUnderAShortHeading", "X[mm];x[mm];Dir\n1;2;+\n1;2;-\n", "X[mm],x[mm],dirX\n1,2,1\n1,2,-1\n"},
    {"NoSense", "X[mm];x[mm];Dir\n1;2;1\n1;2;7\n",
     "refused: s.csv:3: \"7\": an approach direction is 1 or -1"},
    {"RotaryDeviation", "C soll [°];Abweichung C [arcsec]\n90;3,6\n", "C[deg],rz[deg]\n90,90.001\n"},
    {"SecondsOfArcAsAnInchMark", "C [°];Abweichung C [\"]\n90;3,6\n", "C[deg],rz[deg]\n90,90.001\n"},
    {"LengthOfAnAngle", "C [°];Abweichung C [um]\n90;3,6\n", "a length, where C is an angle"},
    {"DeviationWithoutUnit", "X [mm];Abweichung\n90;3,6\n", "--deviation \"X[um]=Abweichung\""},
    {"WordsAreKeptAsLabels", "X[mm];x[mm];Bemerkung\n1;2;gut\n3;4;\n",
     "X[mm],x[mm],Bemerkung\n1,2,gut\n3,4,\n"},
    {"WordsWithANumberAmongThem", "X[mm];x[mm];tool\n1;2;T1\n3;4;7\n5;6;a,b\n",
     "X[mm],x[mm],tool\n1,2,T1\n3,4,7\n5,6,\"a,b\"\n"},
    {"EmptyColumnIsLeftOut", "X[mm];x[mm];spare\n1;2;\n3;4;\n", "X[mm],x[mm]\n1,2\n3,4\n"},
    {"MissingReadings", "X[mm];x[mm]\n1;-\n2;3\n", "X[mm],x[mm]\n1,\n2,3\n"},
    {"QuotedCommas", "X[mm],x[mm]\n\"1,5\",\"2,5\"\n", "X[mm],x[mm]\n1.5,2.5\n"},
    {"Inches", "X (inch);x (inch)\n1;1.0001\n", "X[in],x[in]\n1,1.0001\n"},
    {"Thou", "X [in];dX [thou]\n10;2\n", "X[in],x[mm]\n10,254.0508\n"},
    {"Mil", "X [in];dX [mil]\n10;2\n", "X[in],x[mm]\n10,254.0508\n"},
    {"MinutesOfArc", "C [°];Abweichung C [arcmin]\n90;3\n", "C[deg],rz[deg]\n90,90.05\n"},
    {"Milliradians", "X[mm];rx [mrad]\n1;2,5\n2;3,5\n", "X[mm],rx[mrad]\n1,2.5\n2,3.5\n"},
    {"ColumnARunAndSense", "X [mm];1+;1-;2+;2-\n0;1;2;3;4\n100;5;6;7;\n",
     "refused: s.csv:1: no unit: give it for all (--unit um) or for each, such as --deviation "
     "\"X[um]=1+ to 2-\""},
    {"ColumnARunAndSenseWithUnits", "X [mm];1+ [µm];1- [µm];2+ [µm];2- [µm]\n0;1;2;3;4\n100;5;6;7;\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n100,1,1,100.005\n100,-1,1,100.006\n0,-1,1,0.002\n0,1,2,0.003\n100,1,"
     "2,100.007\n0,-1,2,0.004\n"},
    {"RunsInWords", "Axis Y;;\nDeviations [um];;\nPos [mm];Run 1 fwd;Run 1 bwd\n0;1;2\n100;5;6\n",
     "Y[mm],dirY,run,y[mm]\n0,1,1,0.001\n100,1,1,100.005\n100,-1,1,100.006\n0,-1,1,0.002\n"},
    {"UnitAndSignInATitle", "Achse: X;;\nAbweichungen in µm (Soll-Ist);;\nPos [mm];1+;1-\n0;1;2\n100;5;6\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,-0.001\n100,1,1,99.995\n100,-1,1,99.994\n0,-1,1,-0.002\n"},
    {"RunsInGerman", "Z soll [mm];hin 1 [µm];zurück 1 [µm]\n0;1;2\n100;5;6\n",
     "Z[mm],dirZ,run,z[mm]\n0,1,1,0.001\n100,1,1,100.005\n100,-1,1,100.006\n0,-1,1,0.002\n"},
    {"RunsWithArrows", "Z [mm];Messung 1 ↑ [µm];Messung 1 ↓ [µm]\n0;1;2\n100;5;6\n",
     "Z[mm],dirZ,run,z[mm]\n0,1,1,0.001\n100,1,1,100.005\n100,-1,1,100.006\n0,-1,1,0.002\n"},
    {"RunsOfPositions", "Z soll [mm];1+;1-\n0;0,001;0,002\n100;100,005;100,006\n",
     "Z[mm],dirZ,run,z[mm]\n0,1,1,0.001\n100,1,1,100.005\n100,-1,1,100.006\n0,-1,1,0.002\n"},
    {"SensesWithoutNumbers", "Z [mm];Abw. + [µm];Abw. - [µm];Abw. + [µm];Abw. - [µm]\n0;1;2;3;4\n9;1;2;3;4\n",
     "Z[mm],dirZ,run,z[mm]\n0,1,1,0.001\n9,1,1,9.001\n9,-1,1,9.002\n0,-1,1,0.002\n0,1,2,0.003\n9,1,2,9."
     "003\n9,-1,2,9.004\n0,-1,2,0.004\n"},
    {"RunsWithoutDirections", "X soll [mm];Messung 1 [mm];Messung 2 [mm]\n0;0,1;0,2\n9;9,1;9,2\n",
     "X[mm],run,x[mm]\n0,1,0.1\n9,1,9.1\n0,2,0.2\n9,2,9.2\n"},
    {"OneRunWithoutDirection", "X soll [mm];Lauf 1 + [um];Lauf 1 - [um];Lauf 2 [um]\n0;1;2;3\n9;1;2;3\n",
     "refused: s.csv:1: \"Lauf 2 [um]\": the heading of this run has no approach direction"},
    {"MeanBesideTheRuns", "X [mm];1+ [µm];1- [µm];Mittelwert [µm]\n0;1;2;1,5\n9;1;2;1,5\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n9,1,1,9.001\n9,-1,1,9.002\n0,-1,1,0.002\n"},
    {"MeanDeviationBesideTheReading",
     "X [mm];Abweichung [µm];mittlere Abw. (Mittelwert) [µm]\n0;1;2\n9;1;2\n",
     "X[mm],x[mm]\n0,0.001\n9,9.001\n"},
    {"MeanAlone", "X soll [mm];Mittelwert\n0;0,1\n9;9,1\n",
     "such as --column \"x[mm]=Mittelwert\" for a measured position, or --deviation \"X[um]=Mittelwert\" for "
     "a "
     "deviation"},
    {"MeanDeviationAlone", "X soll [mm];Abweichung Mittelwert [µm]\n0;1\n9;2\n",
     "X[mm],x[mm]\n0,0.001\n9,9.002\n"},
    {"AlignedTextWithHeadingsOfTwoWords",
     "Portal 4, hall of the north, March\nCmd X    Cmd Y    Meas X   Meas Y\n[mm]     [mm]     [mm]     "
     "[mm]\n"
     "0.00     0.00     0.002    0.001\n100.00   50.00    100.004  50.002\n",
     "X[mm],Y[mm],x[mm],y[mm]\n0.00,0.00,0.002,0.001\n100.00,50.00,100.004,50.002\n"},
    {"AlignedTextWithUnitsInTheHeadings",
     " Nominal X (mm)   Actual X (mm)   T (degC)\n 0.0  0.2  20.1\n 9.0  9.1  20.2\n",
     "X[mm],x[mm],T[degC]\n0.0,0.2,20.1\n9.0,9.1,20.2\n"},
    {"TwoTablesBelowEachOther", "Lauf 1\nX [mm];x [mm]\n0;1\n9;10\n\nLauf 2\nX [mm];x [mm]\n0;2\n9;11\n",
     "refused: s.csv:6: a second line of headings: the file has 2 tables (first line: 1, 6); import each "
     "with "
     "--table 1"},
    {"RowsWithoutReadingsBeginNoTable", "X [mm];x [mm];y [mm];Dir\n0;1;2;+\n;n/a;-;+\n9;10;11;+\n",
     "X[mm],x[mm],y[mm],dirX\n0,1,2,1\n,,,1\n9,10,11,1\n"},
    {"TheSameRunTwice", "Z [mm];1+ [um];1+ [um]\n0;1;2\n9;1;2\n",
     "refused: s.csv:1: \"1+ [um]\": the table contains this run twice"},
    {"ThermometersAreNoRuns", "X[mm];x[mm];T1 [°C];T2 [°C]\n1;2;20;21\n2;3;20;21\n",
     "X[mm],x[mm],T1[degC],T2[degC]\n1,2,20,21\n2,3,20,21\n"},
    {"WordInARun", "X [mm];1+ [µm];1- [µm]\n0;1;2\n100;5;bad\n",
     "refused: s.csv:3: \"bad\": not a number, for X"},
    {"TwoLinesOfHeadings", "X;X;Y;Y\nSoll [mm];Ist [mm];Soll [mm];Ist [mm]\n1;1,1;2;2,1\n",
     "X[mm],x[mm],Y[mm],y[mm]\n1,1.1,2,2.1\n"},
    {"TwoLinesAndUnits", "X;X;Temp\nSoll;Ist;\nmm;mm;°C\n1;1,1;20\n", "X[mm],x[mm],Temp[degC]\n1,1.1,20\n"},
    {"TwoLinesWithRunsAbove",
     "X soll;Messung 1;;Messung 2;\nmm;hin µm;zurück µm;hin µm;zurück µm\n0;1;2;3;4\n9;1;2;3;4\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n9,1,1,9.001\n9,-1,1,9.002\n0,-1,1,0.002\n0,1,2,0.003\n"
     "9,1,2,9.003\n9,-1,2,9.004\n0,-1,2,0.004\n"},
    {"TitleOfTwoCellsStaysATitle", "Maschine;DMU 50\nX[mm];x[mm]\n1;2\n", "X[mm],x[mm]\n1,2\n"},
    {"ActualAndDeviation", "X Istposition [mm];Abweichung X [µm]\n100,0015;1,5\n",
     "x[mm],X[mm]\n100.0015,100\n"},
    {"ActualOfTheTitlesAxis", "X-Achse;\nActual [mm];Deviation [µm]\n100,0015;1,5\n",
     "x[mm],X[mm]\n100.0015,100\n"},
    {"DisplayAndReading", "Istposition X [mm];Messwert X [mm]\n100;100,5\n", "X[mm],x[mm]\n100,100.5\n"},
    {"ReadingsOfATracker",
     "Punkt;Soll X [mm];Soll Y [mm];Messpunkt x [mm];Ist y [mm]\nP1;100;50;812,5;-3,25\n",
     "Punkt,X[mm],Y[mm],x[mm],y[mm]\nP1,100,50,812.5,-3.25\n"},
    {"NominalLessActual", "X [mm];Deviation (nominal-actual) [µm]\n100;1,5\n", "X[mm],x[mm]\n100,99.9985\n"},
    {"SollLessIst", "X [mm];Abw. X (Soll − Ist) [µm]\n100;1,5\n", "X[mm],x[mm]\n100,99.9985\n"},
    {"SollLessIstInTheTitle", "Abweichung = Soll - Ist;\nX [mm];Abw. X [µm]\n100;1,5\n",
     "X[mm],x[mm]\n100,99.9985\n"},
    {"IstLessSoll", "X [mm];Abw. X (Ist-Soll) [µm]\n100;1,5\n", "X[mm],x[mm]\n100,100.0015\n"},
    {"AComparisonSaysNoSign", "Soll-Ist-Vergleich;\nX [mm];Abw. X [µm]\n100;1,5\n",
     "X[mm],x[mm]\n100,100.0015\n"},
    {"RunsOfNominalLessActual", "X [mm];1+ (Soll-Ist) [µm];1- (Soll-Ist) [µm]\n0;1;2\n9;1;2\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,-0.001\n9,1,1,8.999\n9,-1,1,8.998\n0,-1,1,-0.002\n"},
    {"NoUnits", "X;x\n1;2\n", "refused: s.csv:1: no unit: give it for all (--unit mm)"},
    {"PointsWithoutUnits", "Punkt;X;Y;Z\nP1;1,5;2,5;3,5\nP2;2,5;3;4\n",
     "If they are points that an instrument measured, such as a laser tracker, and another file LIST has the "
     "positions of the axes, give: vernier import tracker s.csv --machine MACHINE --nominal LIST"},
    {"PointsAlone", "Punkt;X [mm];Y [mm];Z [mm]\nP1;1,5;2,5;3,5\nP2;2,5;3;4\n",
     "refused: s.csv:1: no column of the table is a reading: the table has X, Y and Z alone."},
    {"JointsWithinATurn", "A1;A2;A3;A4;A5;A6\n1.66;0.15;-0.2;-1.78;0.64;-1.98\n0;0.1;0.2;0.3;0.4;3.1\n",
     "--column \"A6[rad]=A6\"; no value of A1 to A6 is larger than a turn in radians: [rad] is proposed"},
    {"TwoSigns", "X[mm];x[mm]\n1,5;2\n3.5;2\n", "--decimal comma or point"},
    {"CommaInCommas", "X[mm],x[mm]\n0,5,1,5\n", "separated by commas, save the table with semicolons"},
    {"Words", "X[mm];x[mm]\n1;2\n2;abc\n3;4\n", "refused: s.csv:3: \"abc\": not a number, for x"},
    {"NothingMeasured", "X[mm];Y[mm]\n1;2\n", "no column of the table is a reading"},
    {"OldWorkbook", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "save it as .xlsx or as CSV"},
    {"NoNumbers", "only;words\nhere;too\n", "no row of this table contains numbers"},
    {"PressureIsNoDeviation", "X [mm];Abweichung [bar]\n100;1\n200;2\n",
     "refused: s.csv:1: \"Abweichung [bar]\": [bar] is no unit of a deviation of X, which needs a unit like "
     "mm "
     "or deg"},
    {"VoltageIsNoReading", "X[mm];x[V]\n1;2\n", "[V] is no unit of x, which needs a unit like mm"},
    {"AVoltageCalledUIsNoAxis", "X[mm];x[mm];U[V];A[A]\n1;2;3;4\n", "X[mm],x[mm],U[V],A[A]\n1,2,3,4\n"},
    {"MassIsNoPosition", "X[kg];x[mm]\n1;2\n", "[kg] is no unit of X"},
    {"DegreesOfTemperatureAreNoAngle", "C[deg];rz[degC]\n1;2\n", "[degC] is no unit of rz"},
    {"SecondsAreNoUncertainty", "X[mm];x[mm];u[s]\n1;2;3\n", "[s] is no unit of u"},
    {"AngleOfALength", "X [mm];Abweichung X [arcsec]\n90;3,6\n", "an angle, where X is a length"},
    {"DateIsNoReading", "X[mm];x[mm]\n1;2026-03-04\n2;2026-03-05\n",
     "refused: s.csv:2: \"2026-03-04\": a date or a time of day, not a number, for x"},
    {"DatesLabelTheirRows", "X[mm];x[mm];Datum\n1;2;2026-03-04\n", "X[mm],x[mm],Datum\n1,2,2026-03-04\n"},
    {"ErrorValueBeginsARow", "X[mm];x[mm]\n1;2\n#REF!;3\n3;4\n", "refused: s.csv:3: \"#REF!\": not a number"},
    {"MeanBelowNamedPoints", "Punkt;X [mm];x [mm]\nP1;0;1\nP2;9;10\nMittelwert;4,5;5,5\n",
     "Punkt,X[mm],x[mm]\nP1,0,1\nP2,9,10\n"},
    {"ComputedRowsBelowThePositions",
     "X [mm];x [mm];T [°C]\n0;1;20\n9;10;21\nMean;5,5;20,5\nMax;10;21\nStd. "
     "dev.;1;1\nStabw;1;1\nAverage;5;20\n",
     "X[mm],x[mm],T[degC]\n0,1,20\n9,10,21\n"},
    {"LargestAndSmallestBelowNamedPoints", "Punkt;X [mm];x [mm]\nP1;0;1\nP2;9;10\nMax;9;10\nMin;0;1\n",
     "Punkt,X[mm],x[mm]\nP1,0,1\nP2,9,10\n"},
    {"ComputedRowsBelowRuns", "X [mm];1+ [µm];1- [µm]\n0;1;2\n9;3;4\nMittelwert;2;3\n",
     "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n9,1,1,9.003\n9,-1,1,9.004\n0,-1,1,0.002\n"},
    {"StatesCalledMinAndMaxAreRows", "Last;X [mm];x [mm]\nmin;0;1\nmax;0;1\nmin;9;10\nmax;9;10\n",
     "Last,X[mm],x[mm]\nmin,0,1\nmax,0,1\nmin,9,10\nmax,9,10\n"},
    {"Microradians", "C [°];Abweichung C [µrad]\n90;3\n", "C[deg],rz[deg]\n90,90.000171887\n"},
    {"MicroradiansOnTheKeyboard", "X[mm];rx [urad]\n1;2\n", "X[mm],rx[urad]\n1,2\n"},
    {"Microinches", "X [in];dX [µin]\n10;2\n", "X[in],x[mm]\n10,254.0000508\n"},
    {"UnknownUnit", "X [mm];Abweichung X [foo]\n10;2\n",
     "refused: s.csv:1: \"Abweichung X [foo]\": [foo] is no known unit; convert the values to a known unit"},
    {"RotaryDeviationWithoutUnit", "C [°];Abweichung C\n90;3\n", "--deviation \"C[arcsec]=Abweichung C\""},
    {"NumberedRows", "Nr;X [mm];x [mm]\n#1;0;1\n#2;9;10\n", "Nr,X[mm],x[mm]\n\"#1\",0,1\n\"#2\",9,10\n"},
    {"NumberedRowsSeparatedByBlanks", "Nr X[mm] x[mm]\n#1 0 1\n#2 9 10\n",
     "Nr,X[mm],x[mm]\n\"#1\",0,1\n\"#2\",9,10\n"},
    {"RowsSwitchedOff", "X [mm];x [mm]\n#0;1\n9;10\n#12;13\n", "X[mm],x[mm]\n9,10\n"},
    {"RemarksWithANumber", "# 1 remark\n#1 remark, long\nX [mm];x [mm]\n9;10\n", "X[mm],x[mm]\n9,10\n"},
    {"RowOfUnitsAgainstTheHeading", "X [mm];x [mm]\n[mm];[µm]\n0;1\n",
     "refused: s.csv:2: \"[µm]\": the heading \"x [mm]\" in line 1 has the unit mm, this cell below it um"},
    {"TwoLinesOfHeadingsOfTwoUnits", "X [mm];X [mm];Y [mm];Y [mm]\nSoll;Ist [um];Soll;Ist\n1;1;2;2\n",
     "refused: s.csv:2: \"Ist [um]\": the heading \"X [mm]\" in line 1 has the unit mm"},
    {"NotANumberIsMissing", "X[mm];x[mm]\n1;NaN\n2;3\n", "X[mm],x[mm]\n1,\n2,3\n"},
    {"UnitsInAllCells", "X[mm];x[mm]\n1 mm;2 mm\n2 mm;3 mm\n",
     "refused: s.csv:2: \"1 mm\": a number with the unit mm, and no row of this table contains numbers; "
     "write the "
     "unit in the heading ([mm])"},
    {"UnitsInTheReadings", "X[mm];x[mm]\n1;2 mm\n2;3 mm\n",
     "refused: s.csv:2: \"2 mm\": a number with the unit mm, for x; write the unit in the heading ([mm])"},
    {"Colons", "X[mm]:x[mm]\n1:2.5\n2:3.5\n", "refused: s.csv:1: \":\": a colon cannot separate columns"},
    {"SmallNumbersHaveNoExponent", "X [mm];Abw. X [µm]\n0;0,6\n1;-1000\n", "X[mm],x[mm]\n0,0.0006\n1,0\n"},
    {"ShortRowsOfBlanks", "X[mm] Y[mm] x[mm]\n0 1 2\n9 10\n",
     "refused: s.csv:3: \"9 10 \": this row has 2 cells, but line 1 has 3 headings"},
    {"UnitsInTheReadingsBehindADecimalComma", "X[mm];x[mm]\n1;0,1 mm\n100;100,002 mm\n",
     "refused: s.csv:2: \"0,1 mm\": a number with the unit mm, for x"},
    {"UnfilledTemplate", "X[mm],dirX,x[mm],y[mm],run\n0,1,,,a\n9,-1,,,a\n",
     "refused: s.csv:1: the columns of readings are empty (x[mm], y[mm]): fill in the readings"},
    {"AnApproachDirectionIsNoReading", "X[mm],dirX\n0,1\n9,-1\n", "such as --column \"x[mm]=HEADING\""},
    {"ReadingOfALaserIsADeviationByItsValues", "Position X [mm];Messwert X [um]\n0;1,5\n100;-2,5\n200;3\n",
     "X[mm],x[mm]\n0,0.0015\n100,99.9975\n200,200.003\n"},
    {"ActualThatIsADeviationByItsValues", "Soll X [mm];Ist X [um]\n0;0,1\n100;2\n200;1\n",
     "X[mm],x[mm]\n0,0.0001\n100,100.002\n200,200.001\n"},
    {"ActualInMicrometresIsAPosition", "Soll X [mm];Ist X [um]\n0;1\n100;100002\n200;200001\n",
     "X[mm],x[um]\n0,1\n100,100002\n200,200001\n"},
    {"ActualInAWrongUnit", "Soll X [mm];Ist X [um]\n0;0,001\n100;100,002\n200;200,001\n",
     "refused: s.csv:1: \"Ist X [um]\": the values follow X with the ratio 1/1000, so they are positions, "
     "and "
     "the unit of one of the two columns is wrong"},
    {"DeviationThatIsAPosition", "Soll X [mm];Abweichung X [mm]\n0;0,001\n100;100,002\n200;200,001\n",
     "refused: s.csv:1: \"Abweichung X [mm]\": the values follow X, so they are positions and not "
     "deviations"},
    {"ActualsInATurnedFrame", "Soll X [mm];Ist X [mm];Ist Y [mm]\n0;5;0\n100;5,01;100\n200;5,02;200\n",
     "X[mm],x[mm],y[mm]\n0,5,0\n100,5.01,100\n200,5.02,200\n"},
    {"NamesOfTheFormatStay", "X[mm];x[um]\n0;1\n100;2\n200;3\n", "X[mm],x[um]\n0,1\n100,2\n200,3\n"},
    {"CorrectionIsNoDeviation", "Soll X [mm];Korrektur X [um]\n0;1\n100;2\n200;3\n",
     "refused: s.csv:1: no column of the table is a reading"},
    {"ReadingsBesideAConstantTarget", "Soll X [mm];Messwert X [um]\n300;0,4\n300;-1,2\n300;2,3\n",
     "X[mm],x[mm]\n300,300.0004\n300,299.9988\n300,300.0023\n"},
    {"PositionOnlyInTheFirstRow", "X [mm];Y [mm];x [mm]\n0;400;1\n9;;10\n",
     "refused: s.csv:3: \"Y\": the position of this axis is empty in a row with a reading"},
    {"OneReading", "Soll X [mm];Messwert X [um]\n100;2,5\n", "X[mm],x[mm]\n100,100.0025\n"},
    {"OneTypingErrorAmongDeviations",
     "Soll X [mm];Messwert X [um]\n0;0,4\n50;99999\n100;2,3\n150;3,1\n200;1\n",
     "X[mm],x[mm]\n0,0.0004\n50,149.999\n100,100.0023\n150,150.0031\n200,200.001\n"},
    {"ReadingsThatAreNeither", "Soll X [mm];Messwert X [um]\n0;8\n0,1;-24\n0,2;46\n0,3;62\n",
     "refused: s.csv:1: \"Messwert X [um]\": the values are neither positions of X nor small deviations from "
     "them; state the meaning: --column \"x[um]=Messwert X [um]\""},
    {"ReadingAndDeviationOfOneAxis",
     "Position X [mm];Messwert X [um];Ist X [mm]\n0;0,4;0,0004\n50;-1,2;49,9988\n100;2,3;100,0023\n",
     "X[mm],x[mm]\n0,0.0004\n50,49.9988\n100,100.0023\n"},
    {"DeviationsOfThreeAxesOneOfWhichMoves",
     "Soll X [mm];Soll Y [mm];Messwert X [um];Messwert Y [um]\n0;400;0,4;0,9\n50;400;-1,2;1\n100;400;2,3;2\n",
     "X[mm],Y[mm],x[mm],y[mm]\n0,400,0.0004,400.0009\n50,400,49.9988,400.001\n100,400,100.0023,400.002\n"},
    {"ActualOfARotaryAxis", "Soll C [°];Ist C [°]\n0;0,001\n30;30,002\n60;59,999\n",
     "C[deg],rz[deg]\n0,0.001\n30,30.002\n60,59.999\n"},
    {"DeviationOfAnAxisWithoutAReading", "Soll U [mm];Abweichung U [um]\n0;1\n100;2\n",
     "refused: s.csv:1: no column of the table is a reading"},
    {"DeviationAfterACorrection", "Soll X [mm];Abweichung X nach Korrektur [um]\n0;1\n100;2\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"DeviationWithoutCompensation", "Soll X [mm];Deviation X without compensation [um]\n0;1\n100;2\n",
     "X[mm],x[mm]\n0,0.001\n100,100.002\n"},
    {"NoBreakBlanks", "X\u202f[mm];x [mm]\n1\u00a0;\u00a02,5\n\u200e2;3,5\u2009\n",
     "X[mm],x[mm]\n1,2.5\n2,3.5\n"},
    {"TablesSideBySideWithoutAnEmptyColumn",
     "X soll [mm];X Abw. [um];Y soll [mm];Y Abw. [um]\n0;1;0;4\n100;2;50;5\n200;3;100;6\n",
     "refused: s.csv:1: X and its readings are in the columns 1 to 2, Y in the columns 3 to 4"},
    {"GridOfTwoAxes",
     "X soll [mm];X Abw. [um];Y soll [mm];Y Abw. [um]\n0;1;0;4\n100;2;0;5\n0;3;50;6\n100;4;50;7\n",
     "X[mm],x[mm],Y[mm],y[mm]\n0,0.001,0,0.004\n100,100.002,0,0.005\n0,0.003,50,50.006\n100,100.004,50,50."
     "007\n"},
    {"TablesSideBySide",
     "X soll [mm];X Abw. [um];;Y soll [mm];Y Abw. [um]\n0;1;;0;4\n100;2;;50;5\n200;3;;100;6\n",
     "refused: s.csv:1: X and its readings are in the columns 1 to 2, Y in the columns 4 to 5"},
    {"AnEmptyColumnBetweenTargetsAndReadings",
     "X soll [mm];Y soll [mm];;X ist [mm];Y ist [mm]\n0;0;;0,1;0,1\n100;50;;100,1;50,2\n",
     "X[mm],Y[mm],x[mm],y[mm]\n0,0,0.1,0.1\n100,50,100.1,50.2\n"},
    {"TheNumberOfARowIsNoReading", "Nr;Pos [mm];Anzeige [um]\n1;100;1\n2;200;2\n",
     "such as --column \"X=Pos [mm]\" --column \"x=Anzeige [um]\""},
    {"CharactersWithoutAWidth", "X\u200b[mm];x [mm]\ufeff\n1;\u200b2,5\n2;3\u2060,5\n",
     "X[mm],x[mm]\n1,2.5\n2,3.5\n"},
    {"OpenQuote", "X[mm];x[mm]\n1;\"2\n", "a closing quote is missing"},
};

class Spreadsheet : public testing::TestWithParam<Case> {};

TEST_P(Spreadsheet, IsReadRightlyOrRefusedWithTheMend) {
  const std::string result = import(GetParam().bytes);
  if (result.starts_with("refused"))
    EXPECT_NE(result.find(GetParam().read), std::string::npos) << result;
  else
    EXPECT_EQ(result, GetParam().read);
}
INSTANTIATE_TEST_SUITE_P(AsPeopleSendThem, Spreadsheet, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

const std::string kOdd = "Pos;Anzeige [µm];Stift\n100;1,5;a\n200;2,5;b\n";

TEST(SheetWish, ColumnsAreAssignedInEitherOrder) {
  const char* const wanted = "Z[mm],x[um],Stift\n100,1.5,a\n200,2.5,b\n";
  EXPECT_EQ(import(kOdd, {},
                   [](SheetWishes& wishes, const SheetTable& table) {
                     assign_column(wishes, table, "Z[mm]=Pos");
                     assign_column(wishes, table, "x=Anzeige [µm]");
                   }),
            wanted);
  EXPECT_EQ(import(kOdd, {},
                   [](SheetWishes& wishes, const SheetTable& table) {
                     assign_column(wishes, table, "1=Z[mm]");
                     assign_column(wishes, table, "Anzeige=x[um]");
                   }),
            wanted);
}

TEST(SheetWish, DeviationIsAddedToThePosition) {
  EXPECT_EQ(import(kOdd, {},
                   [](SheetWishes& wishes, const SheetTable& table) {
                     assign_column(wishes, table, "X[mm]=Pos");
                     assign_deviation(wishes, "X=Anzeige");
                   }),
            "X[mm],x[mm],Stift\n100,100.0015,a\n200,200.0025,b\n");
}

/// A calibrator of six degrees of freedom: one axis moves, the readings are along and about all axes.
TEST(SheetWish, StraightnessIsAddedToThePositionOfAnAxisThatStandsStill) {
  const std::string table =
      "Machine,VMC\nAxis,X\nTarget (mm),Linear error (um),Vertical straightness (um),Pitch (arcsec)\n"
      "0,0,1,2\n100,3,4,5\n";
  const auto say = [](SheetWishes& wishes, const SheetTable& of) {
    assign_deviation(wishes, "Z[um]=Vertical straightness (um)");
    assign_column(wishes, of, "ry[arcsec]=Pitch (arcsec)");
    add_constant_to(wishes, "Z[mm]=250");
  };
  EXPECT_EQ(import(table, {}, say),
            "X[mm],x[mm],z[mm],ry[arcsec],Z[mm]\n0,0,250.001,2,250\n100,100.003,250.004,5,250\n");
  const auto without = [](SheetWishes& wishes, const SheetTable&) {
    assign_deviation(wishes, "Z[um]=Vertical straightness (um)");
  };
  const std::string refused = import(table, {}, without);
  EXPECT_NE(refused.find("--set \"Z[mm]=0\""), std::string::npos) << refused;
}

TEST(SheetWish, ACorrectionIsADeviationOfTheOtherSign) {
  const auto say = [](SheetWishes& wishes, const SheetTable&) {
    assign_deviation(wishes, "X=Korrektur X [um]");
  };
  EXPECT_EQ(import("Soll X [mm];Korrektur X [um]\n0;1\n100;-2\n", {}, say),
            "X[mm],x[mm]\n0,-0.001\n100,100.002\n");
}

TEST(SheetWish, ADeviationOfPositionsIsRefused) {
  const auto say = [](SheetWishes& wishes, const SheetTable&) { assign_deviation(wishes, "X=Ist X [mm]"); };
  const std::string result = import("Soll X [mm];Ist X [mm]\n0;0,1\n50;50,2\n100;100,1\n", {}, say);
  EXPECT_NE(result.find("the values follow X, so they are positions"), std::string::npos) << result;
}

TEST(SheetWish, AxesThatMovedTogetherAreOneMotion) {
  const auto say = [](SheetWishes& wishes, const SheetTable&) { wishes.one_motion = true; };
  EXPECT_EQ(import("X soll [mm];X ist [mm];Y soll [mm];Y ist [mm]\n0;1;0;1\n100;101;50;51\n", {}, say),
            "X[mm],x[mm],Y[mm],y[mm]\n0,1,0,1\n100,101,50,51\n");
}

TEST(SheetWish, EmptyCellsHaveTheValueAboveThem) {
  SheetWords words;
  words.fill = {"T"};
  const SheetReading read =
      read_as_sheet("X [mm];x [mm];T [degC]\n0;1;20\n9;10;\n0;1;21\n9;10;\n", "s.csv", words);
  EXPECT_EQ(measurement_csv(table_of_sheet(read.sheet, read.table, read.columns, read.wishes)),
            "X[mm],x[mm],T[degC]\n0,1,20\n9,10,20\n0,1,21\n9,10,21\n");
  words.fill.clear();
  const SheetReading sparse =
      read_as_sheet("X [mm];x [mm];T [degC]\n0;1;20\n9;10;\n0;1;\n9;10;\n", "s.csv", words);
  ASSERT_EQ(sparse.sheet.notes.size(), 1u);
  EXPECT_NE(sparse.sheet.notes[0].find("3 of 4 cells below \"T [degC]\" are empty"), std::string::npos);
}

TEST(SheetWish, AHeadingThatIsNotThereIsRefusedByItsOption) {
  const std::string bytes = "X [mm];x [mm];T [degC]\n0;1;20\n9;10;\n";
  SheetWords filled, left;
  filled.fill = {"Temp"};
  left.left = {"Bemerkung"};
  for (const auto& [words, start] :
       {std::pair{filled, "--fill \"Temp\": the sheet has no column with this heading"},
        std::pair{left, "--leave \"Bemerkung\": the sheet has no column with this heading"}}) {
    try {
      read_as_sheet(bytes, "s.csv", words);
      FAIL() << start;
    } catch (const text::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(start), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("X [mm], x [mm], T [degC]"), std::string::npos)
          << error.what();
    }
  }
}

TEST(SheetProfile, DoesNotStoreWhatTheValuesDecide) {
  const auto profile_of = [](const std::string& bytes) {
    const SheetReading read = read_as_sheet(bytes, "s.csv", SheetWords{});
    return sheet_profile(read.sheet, read.table, read.columns, read.wishes);
  };
  const std::string text = profile_of("Soll X [mm];Messwert X [mm]\n0;1\n50;50\n100;101\n");
  EXPECT_EQ(text.find("Messwert X [mm] ="), std::string::npos) << text;
  EXPECT_EQ(text.find("decimal"), std::string::npos) << "no number shows the sign";
  EXPECT_NE(profile_of("Soll X [mm];Messwert X [mm]\n0;1,5\n50;50\n100;101\n").find("decimal = comma"),
            std::string::npos);
}

TEST(SheetWish, AnotherUnitThanThatOfTheHeadingIsRefused) {
  const auto say = [](SheetWishes& wishes, const SheetTable& table) {
    assign_column(wishes, table, "y[um]=Ist y [mm]");
  };
  const std::string result = import("Y soll [mm];Ist y [mm]\n0;1\n100;101\n", {}, say);
  EXPECT_NE(result.find("the table states the unit mm, the assignment to y states um"), std::string::npos)
      << result;
}

TEST(SheetWish, OneOfSeveralTablesIsRead) {
  const std::string two = "Lauf 1\nX [mm];x [mm]\n0;1\n9;10\n\nLauf 2\nX [mm];x [mm]\n0;2\n9;11\n";
  SheetWishes wishes;
  wishes.format.table = 2;
  EXPECT_EQ(import(two, wishes), "X[mm],x[mm]\n0,2\n9,11\n");
  wishes.format.table = 1;
  EXPECT_EQ(import(two, wishes), "X[mm],x[mm]\n0,1\n9,10\n");
  wishes.format.table = 3;
  EXPECT_NE(import(two, wishes).find("\"3\": the file has no table of this number: it has 2 tables"),
            std::string::npos);
}

TEST(SheetWish, TheSameInEveryRowIsAReadingToo) {
  SheetWishes wishes;
  ColumnMap map;
  add_constant(map, "x[mm]=0");
  wishes.constants = map.columns;
  EXPECT_EQ(import("X [mm];T\n1;20\n2;21\n", wishes), "X[mm],T,x[mm]\n1,20,0\n2,21,0\n");
  EXPECT_NE(import("X [mm];x [mm]\n1;20\n", wishes).find("the table already has this column: omit --set"),
            std::string::npos);
}

TEST(SheetWish, AConstantMayHaveADecimalComma) {
  const auto with = [](const char* said, const char* bytes) {
    SheetWishes wishes;
    ColumnMap map;
    add_constant(map, said);
    wishes.constants = map.columns;
    return import(bytes, wishes);
  };
  EXPECT_EQ(with("Y[mm]=0,5", "X [mm];x [mm]\n1;2\n"), "X[mm],x[mm],Y[mm]\n1,2,0.5\n");
  EXPECT_EQ(with("Y[mm]=1,234", "X [mm];x [mm]\n1;2,5\n"), "X[mm],x[mm],Y[mm]\n1,2.5,1.234\n");
  EXPECT_NE(
      with("Y[mm]=1,234", "X [mm];x [mm]\n1;2.5\n").find("\"1,234\": for Y: a decimal comma or thousands?"),
      std::string::npos);
  EXPECT_NE(with("Y[mm]=half", "X [mm];x [mm]\n1;2\n").find("\"half\": not a number, for Y"),
            std::string::npos);
  EXPECT_EQ(with("run=1,5", "X [mm];x [mm]\n1;2\n"), "X[mm],x[mm],run\n1,2,\"1,5\"\n");
}

TEST(SheetNote, ASecondColumnOfTheSameNameStatesHowToReadIt) {
  const SheetReading reading = read_as_sheet("X [mm];x [mm];x [mm]\n0;1;2\n9;10;11\n", "s.csv", SheetWords());
  EXPECT_EQ(reading.columns[2].why,
            "column 2 (\"x [mm]\") is already read as x; to read this column instead: --leave 2, or another "
            "name: --column "
            "\"NAME[unit]=3\"");
  SheetWords words;
  words.left = {"2"};
  EXPECT_EQ(read_as_sheet("X [mm];x [mm];x [mm]\n0;1;2\n9;10;11\n", "s.csv", words).columns[2].use,
            SheetColumn::Use::kColumn);
}

TEST(SheetNote, ARunThatOnlyItsFirstRowNamesAppliesToTheRowsBelow) {
  const SheetReading read =
      read_as_sheet("Lauf;X [mm];x [mm]\na;0;1\n;9;10\n;;\nb;0;1\n;9;11\n", "s.csv", SheetWords{});
  EXPECT_EQ(measurement_csv(table_of_sheet(read.sheet, read.table, read.columns, read.wishes)),
            "run,X[mm],x[mm]\na,0,1\na,9,10\nb,0,1\nb,9,11\n");
  ASSERT_EQ(read.sheet.notes.size(), 1u);
  EXPECT_EQ(read.sheet.notes[0], "2 empty cells below \"Lauf\" get the value above them");
}

TEST(SheetNote, NamesEveryRowThatIsLeftOutOrShort) {
  const SheetReading reading = read_as_sheet(
      "Punkt;X [mm];x [mm];y [mm]\nP1;0;1\nP2;9;10;1\nMittelwert;4,5;5,5;1\n", "s.csv", SheetWords());
  const std::vector<std::string> wanted = {
      "line 2: 3 cells, 4 headings: no value for \"y [mm]\"",
      "line 4: the row \"Mittelwert\" is computed from the rows above it and is omitted"};
  EXPECT_EQ(reading.sheet.notes, wanted);
  const SheetReading off = read_as_sheet("X [mm];x [mm]\n0;1\n#9;10\n", "s.csv", SheetWords());
  ASSERT_EQ(off.sheet.notes.size(), 1u);
  EXPECT_EQ(off.sheet.notes[0],
            "line 3 begins with # and is left out: \"#9;10\"; is it a row? (--comment none)");
}

TEST(SheetWish, UnknownHeadingIsNamedWithThoseThatAreThere) {
  const std::string result = import(
      kOdd, {}, [](SheetWishes& wishes, const SheetTable& table) { assign_column(wishes, table, "x=Weg"); });
  EXPECT_NE(
      result.find("the sheet has no column with this heading; its headings are Pos, Anzeige [µm], Stift"),
      std::string::npos)
      << result;
}

TEST(Message, IsUtf8AlsoAboutAFileOfAnotherCodePage) {
  EXPECT_EQ(std::string(InputError({"f.csv", 1}, "x[\xB5m]", "bad").what()), "f.csv:1: \"x[?m]\": bad");
  EXPECT_EQ(std::string(InputError("gr\xFC\xDF \u00b5m").what()), "gr?? \u00b5m");
}

TEST(SheetProfile, ReadsTheNextFileAsThisOne) {
  SheetWishes wishes;
  const Sheet sheet = read_sheet(kOdd, "s.csv", {});
  const SheetTable table = parts_of_sheet(sheet);
  assign_column(wishes, table, "X[mm]=Pos");
  assign_deviation(wishes, "X=Anzeige");
  const std::string profile = sheet_profile(sheet, table, columns_of_sheet(sheet, table, wishes), wishes);
  SheetWishes again;
  read_sheet_profile(again, profile, "p.txt");
  EXPECT_TRUE(again.format.decimal_comma.value());
  EXPECT_EQ(import(kOdd, again), "X[mm],x[mm],Stift\n100,100.0015,a\n200,200.0025,b\n") << profile;
  SheetWishes bad;
  EXPECT_THROW(read_sheet_profile(bad, "colunm X = x[mm]\n", "p.txt"), InputError);
}

TEST(SheetProfile, WhatIsNoCountOfLinesIsRefusedWithItsPlace) {
  for (const char* skip : {"1e100", "1.5", "-1", "99999999999999999999"}) {
    SheetWishes wishes;
    try {
      read_sheet_profile(wishes, std::string("# a profile\nskip = ") + skip + "\n", "p.txt");
      ADD_FAILURE() << skip;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("p.txt:2: \"skip\": "), 0u) << error.what();
    }
  }
}

TEST(SheetProfile, AnUnknownSeparatorIsNamedWithItsPlace) {
  SheetWishes wishes;
  try {
    read_sheet_profile(wishes, "separator = colon\n", "p.txt");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("p.txt:1: \"colon\": "), 0u) << error.what();
  }
}

}  // namespace
}  // namespace vernier::sheet_columns_test
