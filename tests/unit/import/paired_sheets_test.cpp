// SPDX-License-Identifier: GPL-3.0-or-later
// Workbooks with one sheet for each approach direction of an axis.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/import/table_reading.h"
#include "tools/sheet/workbook_writer.h"

namespace vernier::paired_sheets_test {

using namespace vernier::importer;
using sheet::SheetToWrite;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

SheetToWrite sheet_of(const std::string& name, const std::vector<std::vector<std::string>>& rows,
                      const std::string& axis = "X") {
  SheetToWrite sheet;
  sheet.name = name;
  sheet.rows = {{axis + " Soll [mm]", "Abw. " + axis + " [um]"}};
  sheet.rows.insert(sheet.rows.end(), rows.begin(), rows.end());
  return sheet;
}

const std::vector<std::vector<std::string>> kForth = {{"0", "1"}, {"50", "2"}, {"100", "3"}},
                                            kBack = {{"0", "4"}, {"50", "5"}, {"100", "6"}};

TEST(PairedSheets, AreReadAsTwoDirectionsInTheOrderOfTheMotion) {
  const std::string both =
      "X[mm],x[mm],dirX\n0,0.001,1\n50,50.002,1\n100,100.003,1\n100,100.006,-1\n"
      "50,50.005,-1\n0,0.004,-1\nnote";
  for (const auto& [forth, back] : {std::pair<std::string, std::string>{"X vor", "X rück"},
                                    {"X-hin", "X-zurück"},
                                    {"X+", "X-"},
                                    {"forward", "reverse"}})
    EXPECT_THAT(read(sheet::workbook_of({sheet_of(forth, kForth), sheet_of(back, kBack)})),
                AllOf(StartsWith(both), HasSubstr("the rows of the sheet \"" + back + "\" are added")))
        << forth;
  EXPECT_THAT(read(sheet::workbook_of({sheet_of("X rück", kBack), sheet_of("X vor", kForth)})),
              StartsWith("X[mm],x[mm],dirX\n100,100.006,-1\n50,50.005,-1\n0,0.004,-1\n0,0.001,1\n"));
}

TEST(PairedSheets, OfAFallingAxisFollowItsRows) {
  EXPECT_THAT(read(sheet::workbook_of({sheet_of("Z vor", {{"0", "1"}, {"-50", "2"}, {"-100", "3"}}, "Z"),
                                       sheet_of("Z rück", {{"0", "4"}, {"-50", "5"}, {"-100", "6"}}, "Z")})),
              StartsWith("Z[mm],z[mm],dirZ\n0,0.001,-1\n-50,-49.998,-1\n-100,-99.997,-1\n-100,-99.994,1\n"
                         "-50,-49.995,1\n0,0.004,1\n"));
}

TEST(PairedSheets, OneThatTheUserNamesHasItsDirection) {
  SheetWords words;
  words.sheet = "X rück";
  EXPECT_THAT(read(sheet::workbook_of({sheet_of("X vor", kForth), sheet_of("X rück", kBack)}), words),
              StartsWith("X[mm],x[mm],dirX\n100,100.006,-1\n50,50.005,-1\n0,0.004,-1\nnote"));
}

TEST(PairedSheets, WithOtherHeadingsAreRefused) {
  EXPECT_THAT(read(sheet::workbook_of({sheet_of("vor", kForth), sheet_of("rück", kBack, "Y")})),
              HasSubstr("are the two directions of one axis, and their headings are not equal"));
}

TEST(PairedSheets, OtherSheetsStayAlone) {
  const auto alone = [](const std::string& one, const std::string& other) {
    return read(sheet::workbook_of({sheet_of(one, kForth), sheet_of(other, kBack)}));
  };
  EXPECT_THAT(alone("X", "Y"), StartsWith("X[mm],x[mm]\n0,0.001\n50,50.002\n100,100.003\n"));
  EXPECT_THAT(alone("X vor", "Y rück"), StartsWith("X[mm],x[mm]\n"));
  EXPECT_THAT(alone("vor Korrektur", "nach Korrektur"), StartsWith("X[mm],x[mm]\n"));
  EXPECT_THAT(alone("Lauf 1", "Lauf 2"), StartsWith("X[mm],x[mm]\n"));
}

}  // namespace
}  // namespace vernier::paired_sheets_test
