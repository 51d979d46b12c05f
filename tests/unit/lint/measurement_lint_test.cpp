// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/measurement_lint.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "tools/lint/dense_points.h"
#include "tools/lint/lint.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::measurement_lint_test {

using namespace vernier::lint;
using namespace vernier::model;
using namespace vernier::text;
namespace {

const Machine& machine() {
  static const Machine kMachine = parse_machine(
      R"xml(<machine><variables><static><k value="0" nominal="0"/><m value="0" nominal="0"/></static>
      <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
      <inputs><T_column unit="degC" reference="20"/></inputs></variables>
      <transforms><sixdof X="X+k*dirX*T_column" Y="Y+m*vY" Z="Z+lag(k*X,2)"/></transforms></machine>)xml",
      "m.xml");
  return kMachine;
}

struct Case {
  const char* name;
  std::string bytes;
  const char* says;  // part of a finding in one line
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

/// Two runs along X. `sign`: of the deviations of the second run.
std::string two_runs(int sign) {
  std::string rows = "X[mm],Y[mm],Z[mm],x[mm],run\n";
  for (int run = 1; run < 3; ++run) {
    const int of_run = run == 1 ? 1 : sign;
    int at = 0;
    for (const int um : {3, 1, -3, -4, -2, 2, 4, 5}) {
      rows += std::to_string(at) + ",0,-9," + number_text(at + of_run * um / 1000.0) + "," +
              std::to_string(run) + "\n";
      at += 50;
    }
  }
  return rows;
}

const std::string kHead = "X[mm],Y[mm],Z[mm],dirX,vY[mm/s],t[s],T_column[degC],x[mm],y[mm],z[mm],run,role\n";
const std::string kRow1 = "0,0,-300,1,0,1,20,0,0,-300,a,fit\n",
                  kRow2 = "300,200,-100,1,0,2,21,300,200,-100,a,fit\n",
                  kRow3 = "600,400,0,-1,5,3,22,600,400,0,a,check\n";

/// Ten rows along X, readings one to ten µm off; one cell said.
std::string along_x(const std::string& reading, const std::string& unit = "mm", double factor = 1) {
  std::string text = "X[mm],Y[mm],Z[mm],x[" + unit + "]\n";
  for (int i = 0; i < 10; ++i)
    text += std::to_string(60 * i) + ",0,0," +
            (i == 7 && !reading.empty() ? reading : std::to_string((60 * i + 0.001 * i) * factor)) + "\n";
  return text;
}

const Case kCases[] = {
    {"Semicolons", "X[mm];x[mm]\n1;2\n",
     "error: \"X[mm];x[mm]\": columns separated by semicolon, not by comma -- a spreadsheet"},
    {"DecimalCommaBehindSemicolons", "X[mm];x[mm]\n1;2,5\n", "s.csv:2: error: \"2,5\": a decimal comma"},
    {"QuotedDecimalComma", kHead + "0,0,-300,1,0,1,20,\"0,5\",0,-300,a,fit\n" + kRow2,
     "s.csv:2: error: \"0,5\": not a number, in column x -- decimal comma?"},
    {"TrailingCommas", "X[mm],Y[mm],Z[mm],x[mm],,\n1,2,3,4,,\n",
     "the header ends with commas -- the file has empty columns, as a spreadsheet writes them"},
    {"TrailingCommasInRows", "X[mm],Y[mm],Z[mm],x[mm]\n1,2,3,4,,\n2,3,4,5,,\n",
     "s.csv:2: error: commas at the end of the row; the same finding occurs 1 more time, last in line 3"},
    {"ByteOrderMark", "\xEF\xBB\xBF" + kHead + kRow1 + kRow2 + kRow3,
     "remark: the file begins with a byte order mark"},
    {"Utf16", std::string("\xFF\xFEX\0,\0", 6),
     "written in UTF-16 (little endian) -- read it: vernier import table s.csv -o s_read.csv"},
    {"Workbook", "PK\x03\x04",
     "this file is a workbook (.xlsx), not a measurement file -- read it: vernier import table"},
    {"CodePage", "X[\xB5m],Y[mm],Z[mm],x[mm]\n1,2,3,4\n", "not UTF-8"},
    {"UnknownUnit", "X[furlong],Y[mm],Z[mm],x[mm]\n1,2,3,4\n", "\"furlong\": unknown unit -- known are"},
    {"UnitInAnotherSpelling", "X[Inch],Y[mm],Z[mm],x[mm]\n1,2,3,4\n",
     "\"Inch\": unknown unit -- meant is in?"},
    {"UnitInParentheses", "X(mm),Y[mm],Z[mm],x[mm]\n1,2,3,4\n",
     "\"X(mm)\": a column heading is name[unit]; the name has only letters, digits and _ -- meant is X[mm]?"},
    {"NoUnit", "X,Y[mm],Z[mm],x[mm]\n1,2,3,4\n", "\"X\": no unit -- write X[mm]"},
    {"WrongDimension", "X[deg],Y[mm],Z[mm],x[mm]\n1,2,3,4\n",
     "\"X[deg]\": this column needs a unit, for example mm"},
    {"NameTwice", "X[mm],X[mm],Y[mm],Z[mm],x[mm]\n1,1,2,3,4\n", "\"X\": this column occurs twice"},
    {"AxisMissing", "X[mm],Y[mm],x[mm]\n1,2,3\n",
     "\"Z\": the column of this axis is missing -- if the axis did not move, add its position: vernier "
     "import "
     "table FILE --set \"Z[mm]=POSITION\" -o NEW.csv"},
    {"AxisInSmallLetters", "X[mm],Y[mm],z[mm],x[mm]\n1,2,3,4\n", "there is z: names have capitals"},
    {"NothingMeasured", "X[mm],Y[mm],Z[mm]\n1,2,3\n", "no measured column"},
    {"NothingMeasuredNamesTheImport", "J1[deg],Tx[mm]\n1,2\n",
     "if the readings have other names, assign the columns: vernier import table s.csv"},
    {"LengthsBetweenPoints", "Strecke,length[mm]\nAB,165.49\nCD,165.51\n",
     "s.csv:1: error: \"Strecke\": the rows are lengths between two points"},
    {"RunWithTheOppositeSign", two_runs(-1),
     "s.csv:10: warning: \"-0.003\": the deviations of run 2 have the sizes of those of run 1"},
    {"WildCell", along_x("9999"), "s.csv:9: warning: \"9999\": this value of x differs "},
    {"OutlierOfOneReading", along_x("420.070"),
     "s.csv:9: warning: \"420.070\": the deviation 70 um of this reading is far outside the deviations of "
     "the "
     "rows before and behind it (5 to 9 um) -- 1/10 of it agrees with them: is a decimal sign lost?"},
    {"MicronsUnderMillimetres", along_x("", "mm", 1000), "µm under a heading of mm? Write x[um]"},
    {"MillimetresUnderMicrons", along_x("", "um"), "mm under a heading of µm? Write x[mm]"},
    {"CorrectionOfMillimetres", "X[mm],Y[mm],Z[mm],x[mm],correctionX[mm]\n0,0,0,0,12.5\n9,0,0,9,13.5\n",
     "13.5 mm at most"},
    {"UncertaintyOfMillimetresUnderMicrons", "X[mm],Y[mm],Z[mm],x[mm],u[um]\n0,0,0,0,0.002\n9,0,0,9,0.002\n",
     "mm under a heading of µm? Write u[mm]"},
    {"NotFilledIn", kHead + "0,0,-300,1,0,1,20,,,,a,fit\n",
     "no row has a reading -- is this a template without readings?"},
    {"NoHeader", "1,2,3,4\n5,6,7,8\n", "the first line contains numbers, but it must be the header"},
    {"ShortRow", kHead + kRow1 + "1,2,3\n",
     "s.csv:3: error: \"1,2,3\": 3 fields where the header has 12 -- the line is incomplete"},
    {"LongRow", "X[mm],Y[mm],Z[mm],x[mm]\n1,5,2,3,4\n", "5 fields where the header has 4 -- decimal commas?"},
    {"Word", kHead + kRow1 + "1,2,abc,1,0,4,20,1,2,-3,a,fit\n", "\"abc\": not a number, in column Z"},
    {"AxisNeverMoves", kHead + "0,0,-300,1,0,1,20,0,0,-300,a,fit\n5,9,-300,1,0,2,20,5,9,-300,a,fit\n",
     "axis Z never moves: it is at -300 mm in all rows"},
    {"TimeFalls", kHead + kRow1 + "300,200,-100,1,0,0.5,21,300,200,-100,a,fit\n" + kRow3,
     "s.csv:3: warning: \"0.5\": t decreases in run a: 0.5 s after 1 s"},
    {"OutsideTheTravel", kHead + kRow1 + "900,200,-100,1,0,2,21,900,200,-100,a,fit\n",
     "\"900\": X is outside the travel of 0 to 600 mm in 1 of 2 rows"},
    {"Micrometres",
     "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm]\n0,0,-300,0,0,-300000\n600,400,0,600000,400000,0\n300,100,-9,"
     "300000,100000,-9000\n",
     "spread over 1000 times the range of the commanded positions -- the readings are in µm"},
    {"Deviations", "X[mm],Y[mm],Z[mm],x[mm]\n0,0,-300,0.001\n600,400,0,0.004\n300,100,-9,0.002\n",
     "deviations instead of positions?"},
    {"InchesInAMillimetreColumn", "X[mm],Y[mm],Z[mm],x[mm]\n0,0,-11,0\n23.6,15,0,599.44\n11,4,-5,279.4\n",
     "this column covers only 23.6 mm of the travel of 600 mm -- inch read as mm?"},
    {"DirectionNotOne", kHead + "0,0,-300,2,0,1,20,0,0,-300,a,fit\n" + kRow2,
     "\"2\": a direction is 1, -1 or 0"},
    {"RoleMistyped", kHead + kRow1 + "300,200,-100,1,0,2,21,300,200,-100,a,chek\n",
     "\"chek\": a role is fit or check -- did you mean check?"},
    {"MotionMissing", "X[mm],Y[mm],Z[mm],x[mm]\n1,2,-3,4\n2,3,-4,5\n",
     "warning: \"dirX\": a term of the machine file uses this column"},
    {"TimeForALagMissing", "X[mm],Y[mm],Z[mm],x[mm]\n1,2,-3,4\n2,3,-4,5\n",
     "warning: \"t\": a term of the machine file uses this column"},
    {"InputMissing", "X[mm],Y[mm],Z[mm],x[mm]\n1,2,-3,4\n2,3,-4,5\n",
     "\"T_column\": no column for this input: it is 20 in all rows"},
    {"InputMistyped", "X[mm],Y[mm],Z[mm],Tcolumn[degC],x[mm]\n1,2,-3,20,4\n2,3,-4,20,5\n",
     "\"Tcolumn\": the machine file does not use this column -- did you mean T_column?"},
    {"NoUncertainty", kHead + kRow1 + kRow2 + kRow3, "remark: \"u\": no standard uncertainty"},
    {"NoCheckRows", kHead + kRow1 + kRow2, "remark: \"role\": no check rows"},
    {"RowTwice", kHead + kRow1 + kRow2 + kRow1 + kRow3, "s.csv:4: warning: the same row as line 2"},
    {"NormalTooLong", "X[mm],Y[mm],Z[mm],d[mm],nx,ny,nz,px[mm],py[mm],pz[mm]\n1,2,-3,0.1,1,1,0,0,0,0\n",
     "nx ny nz is not a unit vector: its length is 1.414"},
    {"LengthWithoutCentre", "X[mm],Y[mm],Z[mm],length[mm]\n1,2,-3,100\n",
     "\"length\": this column needs cx beside it"},
    {"UncertaintyInMicrometres", "X[mm],Y[mm],Z[mm],x[mm],u[mm]\n1,2,-3,4,5\n2,3,-4,5,5\n",
     "an uncertainty of 5 mm -- µm? Write u[um]"},
    {"Fahrenheit", "X[mm],Y[mm],Z[mm],T_column[degC],x[mm]\n1,2,-3,68,4\n2,3,-4,74.5,5\n",
     "\"T_column\": from 68 to 74.5 degC -- degF, or a heated part (bed, spindle)?"},
    {"CheckRowsOnly", kHead + kRow3, "all rows are check rows"},
    {"EmptyAxisCell", kHead + "0,,-300,1,0,1,20,0,0,-300,a,fit\n" + kRow2,
     "\"Y\": an axis position may not be empty"},
    {"OnlyRemarks", "# nothing\n\n", "the file contains only comments and empty lines"},
    {"OpenQuote", kHead + kRow1 + "\"1,2\n", "a quote without its fellow"},
};

class MeasurementLint : public testing::TestWithParam<Case> {};

TEST_P(MeasurementLint, SaysWhatIsTheMatter) {
  std::string all;
  for (const LintFinding& finding : lint_measurement(GetParam().bytes, "s.csv", &machine()))
    all += in_one_line(finding) + "\n";
  EXPECT_NE(all.find(GetParam().says), std::string::npos) << all;
}
INSTANTIATE_TEST_SUITE_P(Everything, MeasurementLint, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(MeasurementLintOf, AGoodFileSaysNothingThatIsWrong) {
  for (const LintFinding& finding : lint_measurement(kHead + kRow1 + kRow2 + kRow3, "s.csv", &machine()))
    EXPECT_EQ(finding.weight, LintWeight::kRemark) << in_one_line(finding);
}

TEST(MeasurementLintOf, ARowWhereTheChainHasNoValueIsAnError) {
  // GIVEN a term that is divided by a position, and a row at 0
  const Machine pole = parse_machine(
      R"xml(<machine><variables><static><k value="0" nominal="0" unit="mm"/></static>
      <machineaxes><X min="0" max="100"/></machineaxes></variables>
      <transforms><sixdof X="X+k/X"/></transforms></machine>)xml",
      "m.xml");
  const auto findings = lint_measurement("X[mm],x[mm]\n10,10\n0,0\n20,20\n", "s.csv", &pole);
  std::string all;
  for (const LintFinding& finding : findings)
    if (finding.weight == LintWeight::kError) all += in_one_line(finding);
  EXPECT_NE(all.find("finite"), std::string::npos) << all;
}

TEST(MeasurementLintOf, WhatItCallsUsableAFitReads) {
  // A file with no error must be read; one that the reader refuses must have one.
  for (const Case& one : kCases) {
    bool error = false, refused = false;
    for (const LintFinding& finding : lint_measurement(one.bytes, "s.csv", &machine()))
      error |= finding.weight == LintWeight::kError;
    try {
      parse_measurement(one.bytes, "s.csv", machine());
    } catch (const InputError&) {
      refused = true;
    }
    EXPECT_TRUE(error || !refused) << one.name;
  }
}

/// Whatever a fit reads has a measured column for `lint` too.
TEST(MeasurementLintOf, EveryKindOfReadingOfTheFormatsIsOne) {
  const Machine simple = parse_machine(
      R"(<machine><variables><machineaxes><X min="0" max="9"/></machineaxes></variables>
      <transforms><sixdof X="X"/></transforms></machine>)",
      "m.xml");
  for (const std::string beside :
       {"x[mm]|1|2", "ix[arcsec]|1|2", "distance[mm],from|5,2|5,1", "ax,ay,az|0,0,1|0,0,1",
        "length[mm],cx[mm],cy[mm],cz[mm]|5,0,0,0|6,0,0,0"}) {
    const auto cells = parts_of(beside, '|');
    const std::string text = "X[mm],setup," + cells[0] + "\n1,a," + cells[1] + "\n8,a," + cells[2] + "\n";
    EXPECT_NO_THROW(parse_measurement(text, "s.csv", simple)) << text;
    for (const LintFinding& finding : lint_measurement(text, "s.csv", &simple)) {
      EXPECT_NE(finding.weight, LintWeight::kError) << text << in_one_line(finding);
      EXPECT_EQ(finding.what.find("does not use"), std::string::npos) << in_one_line(finding);
    }
  }
  // A distance without its other end is a column of one's own.
  const auto alone = lint_measurement("X[mm],distance[mm]\n1,5\n8,5\n", "s.csv", &simple);
  ASSERT_FALSE(alone.empty());
  EXPECT_NE(in_one_line(alone.front()).find("no measured column (x y z"), std::string::npos);
}

/// Touches are readings: what is missing is in the machine file, not in the table.
TEST(MeasurementLintOf, TouchesOfAMachineWithoutAnArtefactNameTheDeclaration) {
  std::string errors;
  for (const LintFinding& finding :
       lint_measurement("X[mm],Y[mm],Z[mm],on\n1,2,-3,bed\n5,2,-3,bed\n", "s.csv", &machine()))
    if (finding.weight == LintWeight::kError) errors += in_one_line(finding) + "\n";
  EXPECT_EQ(
      errors,
      "s.csv:1: error: \"on\": the machine file has no <artefact>: this column is not read -- declare in "
      "the machine file what the tool point touched (vernier set --artefact bed:TYPE, with plane, line, "
      "point, sphere or cylinder as TYPE)\n");
}

TEST(MeasurementLintOf, RunsOfOneSignSayNothingAboutTheSign) {
  for (const LintFinding& finding : lint_measurement(two_runs(1), "s.csv", &machine()))
    EXPECT_EQ(finding.what.find("opposite sign"), std::string::npos) << in_one_line(finding);
}

TEST(MeasurementLintOf, FilesOfBothKindsAreLookedAtTogether) {
  namespace fs = std::filesystem;
  const std::string folder = testing::TempDir() + "lint_" + std::to_string(getpid());
  fs::create_directories(folder);
  write_file(folder + "/s.csv", "X[mm],x[mm]\n1,2\n2,3\n");
  write_file(folder + "/m.xml",
             "<machine><variables><machineaxes><X/><Y/></machineaxes></variables><transforms><sixdof X=\"X\" "
             "Y=\"Y\"/></transforms></machine>");
  const std::vector<LintedFile> files = lint_files({folder + "/s.csv", folder + "/m.xml"});
  EXPECT_EQ(files[0].kind, LintedKind::kMeasurement);
  EXPECT_FALSE(files[0].usable) << "the machine behind it has a Y";
  EXPECT_EQ(files[1].kind, LintedKind::kMachine);
  EXPECT_TRUE(files[1].usable);
  fs::remove_all(folder);
}

TEST(MeasurementLintOf, PointsMuchDenserThanTheStationsAreNamed) {
  const Machine with_table = parse_machine(
      R"xml(<machine><variables><machineaxes><X min="0" max="600"/><Y min="0" max="400"/></machineaxes>
      <comptables><table axis="X" fit="X"><station loc="0"/><station loc="200"/><station loc="400"/>
      <station loc="600"/></table></comptables></variables><transforms><sixdof X="X+lXx" Y="Y"/></transforms></machine>)xml",
      "m.xml");
  const auto lint = [&](int step, bool line) {
    std::string rows = "X[mm],Y[mm],x[mm],u[um]\n", all;
    for (int x = 0; x <= 600; x += step)
      rows += fmt::format("{0},{1},{0}.001,1\n", x, line ? 200 : (7 * x) % 400);
    for (const LintFinding& finding : lint_measurement(rows, "s.csv", &with_table))
      all += in_one_line(finding) + "\n";
    return all;
  };
  EXPECT_NE(lint(25, true).find("X: 25 positions about 25 mm apart, and the table has stations 200 mm apart"),
            std::string::npos)
      << lint(25, true);
  EXPECT_NE(lint(25, true).find("--stations X=100"), std::string::npos) << "25 readings are 3 for 8 stations";
  EXPECT_EQ(lint(100, true).find("positions about"), std::string::npos) << "few points show no curve";
  EXPECT_EQ(lint(25, false).find("positions about"), std::string::npos) << "poses of both axes are no line";
}

TEST(MeasurementLintOf, StationsAreProposedOnlyWithThreeReadingsForEachOfThem) {
  const auto lint = [](const std::string& fit, int runs, const std::string& reading) {
    const Machine with_table = parse_machine(
        R"xml(<machine><variables><machineaxes><X min="0" max="600"/></machineaxes><comptables><table axis="X" fit=")xml" +
            fit +
            R"xml("><station loc="0"/><station loc="200"/><station loc="400"/><station loc="600"/></table></comptables>
        </variables><transforms><sixdof X="X+lXx" Y="lXy" Z="lXz"/></transforms></machine>)xml",
        "m.xml");
    std::string rows = "X[mm]," + reading + ",u[um]\n", all;
    for (int run = 0; run < runs; ++run)
      for (int x = 0; x <= 600; x += 25)
        rows += fmt::format("{0},{0}.00{1}{2},1\n", x, run, reading == "x[mm]" ? "" : ",0.001,0.002");
    for (const LintFinding& finding : lint_measurement(rows, "s.csv", &with_table))
      all += in_one_line(finding) + "\n";
    return all;
  };
  EXPECT_NE(lint("X", 4, "x[mm]").find("--stations X=25"), std::string::npos) << lint("X", 4, "x[mm]");
  EXPECT_EQ(lint("X Y Z", 2, "x[mm]").find("--stations"), std::string::npos)
      << "50 readings of one coordinate for three columns";
  // A laser measures one column of the table: more stations of the other columns may cost more than the
  // curve.
  EXPECT_NE(lint("X Y Z", 4, "x[mm]").find("This line measures one column of the table only"),
            std::string::npos)
      << lint("X Y Z", 4, "x[mm]");
  EXPECT_EQ(lint("X", 4, "x[mm]").find("one column of the table only"), std::string::npos);
  EXPECT_NE(lint("X Y Z", 4, "x[mm],y[mm],z[mm]").find("--stations X=25"), std::string::npos);
}

TEST(Lint, AQuantityThatAnotherFileHasDeterminesItsTermThere) {
  const std::string machine =
      R"xml(<machine name="m"><variables><static><bX value="0" unit="mm"/><bY value="0" unit="mm"/></static>
      <machineaxes><X min="0" max="100"/><Y min="0" max="100"/></machineaxes></variables>
      <transforms><sixdof X="X+bX*dirX" Y="Y+bY*dirY"/></transforms></machine>)xml";
  const std::string x = "X[mm],dirX,Y[mm],x[mm],u[um]\n0,1,50,0,1\n100,1,50,100,1\n100,-1,50,100,1\n",
                    y = "Y[mm],dirY,X[mm],y[mm],u[um]\n0,1,50,0,1\n100,1,50,100,1\n100,-1,50,100,1\n";
  const auto named = [](const std::vector<LintedFile>& files, const std::string& word) {
    return std::any_of(files.begin(), files.end(), [&](const LintedFile& file) {
      return std::any_of(file.findings.begin(), file.findings.end(),
                         [&](const LintFinding& finding) { return finding.word == word; });
    });
  };
  const std::vector<LintedFile> one = lint_contents({"m.xml", "x.csv"}, {machine, x});
  EXPECT_TRUE(named(one, "dirY"));
  EXPECT_FALSE(named(one, "dirX"));
  const std::vector<LintedFile> both = lint_contents({"m.xml", "x.csv", "y.csv"}, {machine, x, y});
  EXPECT_FALSE(named(both, "dirX"));
  EXPECT_FALSE(named(both, "dirY"));
}

TEST(Lint, AFileWithoutUBesideAFileWithUIsAWarning) {
  const std::string folder = testing::TempDir();
  const std::string with = folder + "/with_u.csv", without = folder + "/without_u.csv";
  text::write_file(with, "X[mm],x[mm],u[um]\n0,0,0.5\n100,100,0.5\n");
  text::write_file(without, "X[mm],x[mm]\n0,0\n100,100\n");
  const auto weight_of_u = [](const LintedFile& file) {
    for (const LintFinding& finding : file.findings)
      if (finding.word == "u") return std::optional(finding.weight);
    return std::optional<LintWeight>();
  };
  const std::vector<LintedFile> alone = lint_files({without});
  EXPECT_EQ(weight_of_u(alone[0]), LintWeight::kRemark);
  const std::vector<LintedFile> both = lint_files({with, without});
  EXPECT_FALSE(weight_of_u(both[0]));
  EXPECT_EQ(weight_of_u(both[1]), LintWeight::kWarning);
}

TEST(ImportCommand, IsGivenForSpreadsheetsOnly) {
  EXPECT_EQ(import_command_for("X[mm],x[mm]\n1,2\n", "a.csv"), "");
  EXPECT_EQ(import_command_for("X[mm];x[mm]\n1;2\n", "a b.csv"),
            "vernier import table 'a b.csv' -o 'a b_read.csv'");
  EXPECT_NE(import_command_for("X (mm),x (mm)\n1,2\n", "a.csv"), "");
  EXPECT_NE(import_command_for("X[mm],x[mm],,\n1,2,,\n", "a.csv"), "");
  EXPECT_EQ(import_command_for("<machine/>", "a.xml"), "");
  EXPECT_EQ(import_command_for("HEADER::", "run 1.RTL"),
            "vernier import laser 'run 1.RTL' -o 'run 1_read.csv'");
}

TEST(MeasurementLint, ReportsDirectionsAgainstTheOrderOfTheRows) {
  const auto warned = [](const std::string& rows) {
    for (const LintFinding& one : lint_measurement("Z[mm],dirZ,run,z[mm]\n" + rows, "m.csv", nullptr))
      if (one.what.find("contradict the order of the rows") != std::string::npos) return in_one_line(one);
    return std::string();
  };
  const std::string down = "0,{0},1,0\n-50,{0},1,-50\n-100,{0},1,-100\n-150,{0},1,-150\n";
  const std::string up = "-150,{0},1,-150\n-100,{0},1,-100\n-50,{0},1,-50\n0,{0},1,0\n";
  const auto with = [](const std::string& rows, int sense) { return fmt::format(fmt::runtime(rows), sense); };
  const std::string both = warned(with(down, 1) + with(up, -1));
  EXPECT_TRUE(
      both.starts_with("m.csv:2: warning: \"dirZ\": the directions contradict the order of the rows in "
                       "all 2 runs along Z: the positions decrease from row to row, and dirZ is 1"))
      << both;
  EXPECT_EQ(warned(with(down, -1) + with(up, 1)), "");
  EXPECT_EQ(warned(with(down, 1) + with(down, -1)), "") << "a table that is sorted";
}

// A file of one long word was printed whole, with its terminal sequences.
TEST(MeasurementLint, PositionsReachedFromBothSidesNeedDirections) {
  const auto said = [](const std::string& rows) {
    for (const LintFinding& one : lint_measurement(rows, "m.csv", nullptr))
      if (one.what.find("from both sides of X") != std::string::npos) return in_one_line(one);
    return std::string();
  };
  const std::string there = "0,0\n50,50\n100,100\n150,150\n", back = "200,200\n150,150\n100,100\n50,50\n";
  EXPECT_THAT(
      said("X[mm],x[mm]\n" + there + back),
      testing::HasSubstr("the rows reach 3 positions from both sides of X, and the file has no dirX"));
  EXPECT_EQ(said("X[mm],x[mm]\n" + there + there + there), "") << "the way back has no readings";
  EXPECT_EQ(said("X[mm],x[mm]\n" + there + "120,120\n70,70\n20,20\n"), "") << "other positions";
  EXPECT_EQ(said("X[mm],dirX,x[mm]\n0,0,0\n50,1,50\n100,1,100\n150,1,150\n200,1,200\n150,-1,150\n"
                 "100,-1,100\n50,-1,50\n"),
            "");
}

TEST(Lint, AFileWithoutDirectionsBesideAFileWithThemIsAWarning) {
  const std::string folder = testing::TempDir();
  const std::string with = folder + "/with_sense.csv", without = folder + "/without_sense.csv",
                    still = folder + "/still.csv", axes = folder + "/axes.xml";
  text::write_file(
      axes,
      R"(<machine><variables><machineaxes><X min="0" max="600"/><Y min="0" max="400"/></machineaxes>
                   </variables><transforms><sixdof X="X" Y="Y"/></transforms></machine>)");
  text::write_file(with, "X[mm],Y[mm],dirX,x[mm],u[um]\n0,0,1,0,1\n100,0,1,100,1\n0,0,-1,0,1\n");
  text::write_file(without, "X[mm],Y[mm],x[mm],u[um]\n0,0,0,1\n100,200,100,1\n");
  text::write_file(still, "X[mm],Y[mm],y[mm],u[um]\n5,0,0,1\n5,200,200,1\n");
  const auto warned = [](const LintedFile& file) {
    return std::any_of(file.findings.begin(), file.findings.end(),
                       [](const LintFinding& one) { return one.word == "dirX"; });
  };
  const std::vector<LintedFile> files = lint_files({axes, with, without, still});
  EXPECT_FALSE(warned(files[1]));
  EXPECT_TRUE(warned(files[2]));
  EXPECT_FALSE(warned(files[3])) << "X stood still";
  // Another file of the call moves X; alone, the file measures no error of it.
  const auto stands = [](const LintedFile& file) {
    return std::any_of(file.findings.begin(), file.findings.end(), [](const LintFinding& one) {
      return one.word == "X" && one.what.find("never moves") != std::string::npos;
    });
  };
  EXPECT_FALSE(stands(files[3]));
  EXPECT_TRUE(stands(lint_files({axes, still}).back()));
}

TEST(LintLine, QuotesAShortWordAndNoControlCharacter) {
  LintFinding finding;
  finding.file = "a\033[31m.csv";
  finding.line = 3;
  finding.word = std::string(1'000'000, 'x') + "\033[0m";
  finding.what = "unknown \033]0;title\a";
  const std::string line = in_one_line(finding);
  EXPECT_LT(line.size(), 400u);
  EXPECT_EQ(line.find('\033'), std::string::npos);
  EXPECT_TRUE(line.starts_with("a?[31m.csv:3: ")) << line;
  EXPECT_NE(line.find("x... (999804 more bytes)"), std::string::npos) << line;
}

TEST(Messages, OfACommandAreShortAndPrintable) {
  const text::InputError error({"b\033.csv", 2}, std::string(5000, 'y'), "unknown");
  EXPECT_LT(std::string(error.what()).size(), 300u);
  EXPECT_EQ(text::shown_message("a\033b\nc\rd\n"), "a?b\nc?d\n") << "its lines stay lines";
  EXPECT_LT(text::shown_message(std::string(30'000'000, 'z')).size(), 5000u);
  // The cut is between characters.
  EXPECT_TRUE(
      text::quotable(std::string(199, 'a') + "\u00b5m").starts_with(std::string(199, 'a') + "... (3"));
}

}  // namespace
}  // namespace vernier::measurement_lint_test
