// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "tools/sheet/heading.h"
#include "tools/sheet/several_tables.h"
#include "tools/sheet/sheet_number.h"
#include "tools/sheet/unit_factor.h"
#include "tools/sheet/workbook.h"
#include "tools/text/error.h"

namespace vernier::sheet_test {

using namespace vernier::sheet;
using namespace vernier::text;
namespace {

using Text = std::string;

TEST(Encoding, IsToldByMarkAndByBytes) {
  EXPECT_EQ(encoding_of("a,b\n"), Encoding::kUtf8);
  EXPECT_EQ(encoding_of("\xEF\xBB\xBF"
                        "a"),
            Encoding::kUtf8Bom);
  EXPECT_EQ(encoding_of(Text("\xFF\xFE"
                             "a\0;\0",
                             6)),
            Encoding::kUtf16Le);
  EXPECT_EQ(encoding_of(Text("\xFE\xFF\0a\0;", 6)), Encoding::kUtf16Be);
  EXPECT_EQ(encoding_of(Text("a\0;\0b\0\n\0", 8)), Encoding::kUtf16Le);  // without a mark
  EXPECT_EQ(encoding_of("\xB5m"), Encoding::kWindows1252);
  // Two files joined: each line in its own encoding.
  const std::string mixed =
      "Abweichung [\xC2\xB5m]\nR\xFC"
      "cklauf\n";
  EXPECT_TRUE(mixes_encodings(mixed));
  EXPECT_FALSE(mixes_encodings("[\xC2\xB5m]\n"));
  EXPECT_FALSE(mixes_encodings("[\xB5m]\n"));
  EXPECT_EQ(utf8_text(mixed),
            "Abweichung [\xC2\xB5m]\nR\xC3\xBC"
            "cklauf\n");
  EXPECT_EQ(encoding_of("\xC2\xB5m"), Encoding::kUtf8);
}

TEST(Encoding, LettersBecomeUtf8) {
  EXPECT_EQ(utf8_of("\xB5m \xB0"
                    "C \x80 \x96",
                    Encoding::kWindows1252),
            "µm °C € –");
  EXPECT_EQ(utf8_of(Text("\xFF\xFE\xB5\0m\0\x3D\xD8\x00\xDE", 10), Encoding::kUtf16Le), "µm\U0001F600");
  EXPECT_EQ(utf8_of(Text("\xFE\xFF\0\xB5\0m", 6), Encoding::kUtf16Be), "µm");
  EXPECT_EQ(utf8_of(Text("\xFF\xFE\x3D\xD8", 4), Encoding::kUtf16Le), "\uFFFD");  // half a letter
}

struct Number {
  const char* cell;
  bool comma;
  const char* plain;  // nullptr: no number
};

TEST(SheetNumber, ReadsEverySignThatSpreadsheetsWrite) {
  const Number kNumbers[] = {{"1,5", true, "1.5"},
                             {"1.5", false, "1.5"},
                             {"1,5", false, nullptr},
                             {"1.5", true, nullptr},
                             {"1.234,5", true, "1234.5"},
                             {"1,234.5", false, "1234.5"},
                             {"1'234.5", false, "1234.5"},
                             {"1 234,5", true, "1234.5"},
                             {"\u2212"
                              "0,2",
                              true, "-0.2"},
                             {"+3", true, "3"},
                             {"1e-3", false, "1e-3"},
                             {"0,125", true, "0.125"},
                             {"0,125", false, nullptr},
                             {"12.03.2026", true, nullptr},
                             {"14:05", false, nullptr},
                             {"1,2,3", true, nullptr},
                             {"abc", false, nullptr},
                             {"", false, nullptr},
                             {"1234,567", false, nullptr},
                             {"1,23,456", false, nullptr},
                             {"100,5045", false, nullptr},
                             {"1,234,5678", false, nullptr}};
  for (const Number& one : kNumbers) {
    const auto plain = plain_number(one.cell, one.comma);
    EXPECT_EQ(plain.value_or("none"), one.plain == nullptr ? "none" : one.plain)
        << one.cell << (one.comma ? " comma" : " point");
  }
  EXPECT_EQ(decimal_sign_in("1,5"), DecimalSign::kComma);
  EXPECT_EQ(decimal_sign_in("1.5"), DecimalSign::kPoint);
  EXPECT_EQ(decimal_sign_in("1,234"), DecimalSign::kEither);
  EXPECT_EQ(decimal_sign_in("1.234,5"), DecimalSign::kComma);
  EXPECT_EQ(decimal_sign_in("12"), DecimalSign::kNeither);
}

TEST(Heading, PartsNameAndUnit) {
  const auto parts = [](const char* cell) {
    const Heading heading = parse_heading(cell);
    return heading.name + "|" + heading.unit;
  };
  EXPECT_EQ(parts("X [mm]"), "X|mm");
  EXPECT_EQ(parts("X(mm)"), "X|mm");
  EXPECT_EQ(parts("X / mm"), "X|mm");
  EXPECT_EQ(parts("X in µm"), "X|um");
  EXPECT_EQ(parts("X, \u03bcm"), "X|um");
  EXPECT_EQ(parts("Abweichung X [µm]"), "Abweichung X|um");
  EXPECT_EQ(parts("Temp. Spindel (°C)"), "Temp. Spindel|degC");
  EXPECT_EQ(parts("Vorschub [mm/Min.]"), "Vorschub|mm/min");
  EXPECT_EQ(parts("Drehzahl U/min"), "Drehzahl|rpm");
  EXPECT_EQ(parts("x_mm"), "x|mm");
  EXPECT_EQ(parts("Y inch"), "Y|in");
  EXPECT_EQ(parts("X soll"), "X soll|");
  EXPECT_EQ(parts("T_column[degC]"), "T_column|degC");
  // A factor beside the unit belongs to the unit, before it or behind it.
  for (const char* text : {"dX Hundertstel [mm]", "dX 1/100 [mm]", "dX 0,01 [mm]", "dX [mm] in Hundertstel",
                           "dX in 10^-2 mm", "dX 1 / 100 mm", "dX Skt 0,01 mm"})
    EXPECT_EQ(parts(text), "dX|0.01mm") << text;
  EXPECT_EQ(parts("dX Tausendstel [mm]"), "dX|um");
  EXPECT_EQ(parts("dX Zehntel-µm"), "dX|0.1um");
  EXPECT_EQ(parts("dX in 1/10 µm"), "dX|0.1um");
  EXPECT_EQ(parts("dX Tausendstel Zoll"), "dX|thou");
  EXPECT_EQ(parts("dX ten-thousandths of an inch"), "dX|0.0001in");
  EXPECT_EQ(parts("dX tenths of a thou"), "dX|0.0001in");
  EXPECT_EQ(parts("dC in 1/100 °"), "dC|0.01deg");
  EXPECT_EQ(parts("dC Tausendstel Grad"), "dC|0.001deg");
  // A factor that makes no known unit leaves the column without one.
  for (const char* text :
       {"dX 0,5 µm", "dX in 2 µm", "Abweichung X 2 µm", "Abweichung X 10 mm", "dX Skt 0,002 mm", "dX 0,02 mm",
        "dX 1/20 mm", "dX [mm] x1000", "dX mm x 100", "dX in mm/100", "dX [10e-3 mm]", "dX Skt [mm]"}) {
    EXPECT_EQ(parse_heading(text).unit, "") << text;
    EXPECT_TRUE(has_factor(parse_heading(text).unknown_unit)) << text;
  }
  // Numbers of a heading that are no factor.
  for (const char* text :
       {"X 500 [mm]", "X500 [mm]", "Pos. 1 mm", "Y=400 mm", "Y=0,5 [mm]", "X [mm] (Messuhr 0,01 mm)"})
    EXPECT_EQ(parse_heading(text).unit, "mm") << text;
  for (const char* text : {"Lauf 1 [um]", "Lauf 1/10 [um]", "Messung 10 µm"})
    EXPECT_EQ(parse_heading(text).unit, "um") << text;
  EXPECT_EQ(parts("Temperatur 20 °C"), "Temperatur 20|degC");
  EXPECT_EQ(parse_heading("x [furlong]").unknown_unit, "furlong");
  EXPECT_EQ(name_from_words("Länge über alles (2)"), "Laenge_ueber_alles_2");
}

TEST(Sheet, SeparatorIsWhatTheLinesAgreeOn) {
  EXPECT_EQ(guess_separator("a;b\n1,5;2,5\n", "#"), ';');
  EXPECT_EQ(guess_separator("a,b\n1.5,2.5\n", "#"), ',');
  EXPECT_EQ(guess_separator("a\tb\n1,5\t2,5\n", "#"), '\t');
  EXPECT_EQ(guess_separator("a b\n1.5 2.5\n", "#"), ' ');
  EXPECT_EQ(guess_separator("sep=|\na|b\n", "#"), '|');
  EXPECT_EQ(guess_separator("\"a;b\",c\n\"1;2\",3\n", "#"), ',');
}

TEST(Sheet, BothDecimalSignsAreRefusedWithBothPlaces) {
  try {
    read_sheet("a;b\n1,5;2\n3;2.5\n4;1,25\n", "s.csv");
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("s.csv:3: \"2.5\""), std::string::npos) << text;
    EXPECT_NE(text.find("line 2 (1,5)"), std::string::npos) << text;
    EXPECT_NE(text.find("--decimal"), std::string::npos) << text;
  }
}

TEST(Sheet, DoubtfulSignIsSaid) {
  const Sheet sheet = read_sheet("a;b\n1,234;2,345\n", "s.csv");
  EXPECT_TRUE(sheet.decimal_comma);
  EXPECT_TRUE(sheet.decimal_doubtful);
  EXPECT_FALSE(read_sheet("a;b\n1.234;2.345\n", "s.csv").decimal_comma);
}

TEST(Sheet, PartsAreTitleHeadingsUnitsAndData) {
  const Sheet sheet = read_sheet("Survey of 12.03.2026;;\n;;\nX;x;T\nmm;µm;°C\n1;2;3\n", "s.csv");
  const SheetTable table = parts_of_sheet(sheet);
  ASSERT_EQ(table.headings.size(), 3u);
  EXPECT_EQ(table.headings[1].unit, "um");
  EXPECT_EQ(sheet.line[table.heading_row], 3u);
  EXPECT_EQ(sheet.line[table.first_data], 5u);
}

// A line of many separators over many short lines: as many cells in each would be 10^10.
TEST(Sheet, OneRowFarWiderThanTheOthersIsNoTable) {
  std::string text = "a,b" + std::string(10'000, ',') + "c\n";
  for (int i = 0; i < 100'000; ++i) text += "1,2\n";
  try {
    read_sheet(text, "s.csv", {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("s.csv:1: this row has 10002 cells"), 0u) << error.what();
  }
  // A wide title over a table is one.
  text = "title" + std::string(200, ',') + "x\n";
  for (int i = 0; i < 1000; ++i) text += "1,2\n";
  EXPECT_EQ(read_sheet(text, "s.csv", {}).rows.size(), 1001u);
}

// The columns of a spreadsheet at most; more took minutes, and the workbench waited.
TEST(Sheet, MoreColumnsThanASpreadsheetHasAreRefusedWithTheirLine) {
  EXPECT_EQ(read_sheet("# title\nX" + std::string(kMostColumns - 1, ';') + "1\n", "s.csv").rows.size(), 1u);
  try {
    read_sheet("# title\nX" + std::string(kMostColumns, ';') + "1\n", "s.csv");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("s.csv:2: 16385 columns separated by semicolon"), 0u)
        << error.what();
  }
}

TEST(Sheet, TablesSideBySideAreChosenByTheirNumber) {
  const std::string text =
      "X-Achse;;;;Y-Achse;;\nSoll;vor;r;;Soll;vor;r\n0;1;2;;0;5;6\n50;1;2;;33;5;6\n100;1;2;;66;5;6\n150;1;2;;"
      ";;\n";
  const Sheet sheet = read_sheet(text, "s.csv");
  const std::vector<TableBeside> tables = tables_side_by_side(sheet);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[1].title, "Y-Achse");
  EXPECT_EQ(tables[1].first, 4u);
  Sheet second = sheet;
  keep_table(second, 2);
  ASSERT_EQ(second.rows.size(), 5u);  // the last row has no cell there
  EXPECT_EQ(second.rows[3], (std::vector<std::string>{"33", "5", "6"}));
  Sheet third = sheet;
  EXPECT_THROW(keep_table(third, 3), InputError);
  Sheet all = sheet;
  keep_table(all, std::nullopt);
  EXPECT_EQ(all.rows, sheet.rows);
  std::string other = text;  // other headings: two columns of one table
  EXPECT_TRUE(tables_side_by_side(read_sheet(other.replace(other.rfind("vor"), 3, "Ist"), "s.csv")).empty());
}

/// Processor time of reading a cell of so many blanks and a digit, the least of three, in clock ticks.
std::clock_t time_of_a_cell(std::size_t blanks) {
  const std::string text = "X,x\n1," + std::string(blanks, ' ') + "2\n";
  std::clock_t least = std::numeric_limits<std::clock_t>::max();
  for (int i = 0; i < 3; ++i) {
    const std::clock_t begin = std::clock();
    const Sheet sheet = read_sheet(text, "s.csv");
    least = std::min(least, std::clock() - begin);
    EXPECT_EQ(sheet.rows[1][1], "2");
  }
  return least;
}

// Each letter of a cell used to cost the length of the blanks before it: 2 MB of blanks took ten seconds.
// Eight times the length is then 64 times the time; 24 lies between.
TEST(Sheet, TimeOfACellGrowsWithItsLengthOnly) {
  EXPECT_LT(time_of_a_cell(1'600'000), 24 * time_of_a_cell(200'000));
}

}  // namespace
}  // namespace vernier::sheet_test
