// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/workbook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <map>

#include "tools/sheet/dates.h"
#include "tools/sheet/formatted_columns.h"
#include "tools/sheet/sheet.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::workbook_test {

using namespace vernier::sheet;
using namespace vernier::text;
namespace {

std::string bytes_of(const std::string& name) {
  return read_file(std::string(VERNIER_SOURCE_DIR) + "/tests/data/sheets/" + name);
}
std::string refusal(const std::string& bytes, const std::string& sheet) {
  try {
    read_workbook(bytes, "b.xlsx", sheet);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A workbook of one sheet with these texts and rows.
/// second: the rows of a further sheet T. state: further attributes of the first sheet, if there are two.
std::string workbook_of(const std::string& strings, const std::string& rows, const std::string& styles = "",
                        const std::string& second = "", const std::string& state = "",
                        const std::map<std::string, std::string>& more = {}) {
  std::map<std::string, std::string> parts = {
      {"xl/workbook.xml",
       "<workbook><sheets><sheet name=\"S\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"},
      {"xl/_rels/workbook.xml.rels",
       "<Relationships><Relationship Id=\"rId1\" Target=\"worksheets/sheet1.xml\"/></Relationships>"},
      {"xl/sharedStrings.xml", "<sst>" + strings + "</sst>"},
      {"xl/worksheets/sheet1.xml", "<worksheet><sheetData>" + rows + "</sheetData></worksheet>"}};
  if (!second.empty()) {
    parts["xl/workbook.xml"] = "<workbook><sheets><sheet name=\"S\" sheetId=\"1\" r:id=\"rId1\" " + state +
                               "/><sheet name=\"T\" sheetId=\"2\" r:id=\"rId2\"/></sheets></workbook>";
    parts["xl/_rels/workbook.xml.rels"] =
        "<Relationships><Relationship Id=\"rId1\" Target=\"worksheets/sheet1.xml\"/><Relationship "
        "Id=\"rId2\" Target=\"worksheets/sheet2.xml\"/></Relationships>";
    parts["xl/worksheets/sheet2.xml"] = "<worksheet><sheetData>" + second + "</sheetData></worksheet>";
  }
  for (const auto& [name, text] : more) parts[name] = text;
  if (!styles.empty()) parts["xl/styles.xml"] = "<styleSheet>" + styles + "</styleSheet>";
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const medium = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(medium);
  zip_t* const zip = zip_open_from_source(medium, ZIP_CREATE | ZIP_TRUNCATE, &error);
  for (const auto& [name, text] : parts)
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), ZIP_FL_OVERWRITE);
  EXPECT_EQ(zip_close(zip), 0);
  zip_stat_t status;
  EXPECT_EQ(zip_source_stat(medium, &status), 0);
  std::string bytes(status.size, '\0');
  zip_source_open(medium);
  EXPECT_EQ(zip_source_read(medium, bytes.data(), bytes.size()), static_cast<zip_int64_t>(bytes.size()));
  zip_source_close(medium);
  zip_source_free(medium);
  return bytes;
}

TEST(Workbook, CellsOfTheFirstSheetThatHasSome) {
  const WorkbookSheet sheet = read_workbook(bytes_of("survey.xlsx"), "b.xlsx", "");
  EXPECT_EQ(sheet.name, "Messung");
  ASSERT_EQ(sheet.rows.size(), 8u);
  EXPECT_EQ(sheet.line, (std::vector<std::size_t>{1, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(sheet.rows[1],
            (std::vector<std::string>{"X soll", "X ist", "Temp.", "Lauf"}));  // one of two runs of text
  EXPECT_EQ(sheet.rows[4],
            (std::vector<std::string>{"100", "100.0034", "20.2", "hin"}));  // a formula's last value
  EXPECT_EQ(sheet.rows[5][1], "200.0051");                                  // stored as 200.00509999999997
  EXPECT_EQ(sheet.rows[6],
            (std::vector<std::string>{"200", "200.0011", "", "zurück"}));  // a cell that is not there
}

TEST(Workbook, CoverSheetIsNotTheTable) {
  const WorkbookSheet sheet = read_workbook(bytes_of("cover.xlsx"), "b.xlsx", "");
  EXPECT_EQ(sheet.name, "Daten");
  EXPECT_EQ(sheet.all, (std::vector<std::string>{"Deckblatt", "Daten", "Leer"}));
  EXPECT_EQ(sheet.rows.size(), 4u);
  EXPECT_EQ(read_workbook(bytes_of("cover.xlsx"), "b.xlsx", "1").rows[1],
            (std::vector<std::string>{"Auftrag", "4711"}));
}

TEST(Workbook, NumbersStoredAsTextMakeATableToo) {
  const auto text = [](const char* value) {
    return std::string("<c t=\"inlineStr\"><is><t>") + value + "</t></is></c>";
  };
  const auto row = [&](const char* a, const char* b) { return "<row>" + text(a) + text(b) + "</row>"; };
  const std::string cover = row("Report", "Portal 4") + row("Operator", "K. M.");
  const std::string table = row("X [mm]", "x [mm]") + row("0", "0,001") + row("100", "100,002");
  EXPECT_EQ(read_workbook(workbook_of("", cover, "", table), "b.xlsx", "").name, "T");
}

const std::string kRowsOfNumbers =
    "<row r=\"1\"><c><v>1</v></c><c><v>2</v></c></row><row r=\"2\"><c><v>3</v></c><c><v>4</v></c></row>";

TEST(Workbook, NumberFormatsThatShowMoreThanTheNumber) {
  const auto read = [](const std::string& code, const std::string& heading) {
    const std::string styles = "<numFmts><numFmt numFmtId=\"164\" formatCode='" + code +
                               "'/></numFmts><cellXfs><xf/><xf numFmtId=\"164\"/></cellXfs>";
    std::string rows =
        "<row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>Lauf</t></is></c><c r=\"B1\" "
        "t=\"inlineStr\"><is><t>" +
        heading + "</t></is></c></row>";
    for (const std::string row : {"2", "3"})
      rows += "<row r=\"" + row + "\"><c r=\"A" + row + "\"><v>1</v></c><c r=\"B" + row +
              "\" s=\"1\"><v>-1.5</v></c></row>";
    Sheet sheet = read_sheet(workbook_of("", rows, styles), "b.xlsx");
    take_number_formats(sheet);
    return sheet;
  };
  const auto note = [&](const std::string& code, const std::string& heading) {
    return text::joined(read(code, heading).notes, "; ");
  };
  using testing::HasSubstr;
  EXPECT_THAT(note("0.0\" x 0,1 µm\"", "Abw. [µm]"),
              HasSubstr("of 2 cells from B2 on shows \"x 0,1 µm\": the numbers are read as they are stored "
                        "(-1.5)"));
  EXPECT_THAT(note("\"-\"0.0;\"+\"0.0", "Abw. [µm]"), HasSubstr("shows another sign"));
  EXPECT_THAT(note("0.0;0.0", "Abw. [µm]"), HasSubstr("shows another sign"));
  EXPECT_THAT(note("0%", "Abw. [µm]"), HasSubstr("shows the number times 100"));
  EXPECT_THAT(note("0.0,", "Abw. [µm]"), HasSubstr("shows the number divided by 1000"));
  EXPECT_THAT(note("0.000\" in\"", "X [mm]"), HasSubstr("shows \"in\""));
  // A heading without a unit gets that of the format.
  EXPECT_EQ(read("0.000\" in\"", "X").rows[0][1], "X [in]");
  EXPECT_THAT(note("0.000\" in\"", "X"), HasSubstr("the heading \"X\" has no unit: [in] is the unit"));
  for (const char* const plain :
       {"General", "0.000", "#,##0.00", "0.00E+00", "+0.0;-0.0;0.0", "0.0;[Red]-0.0", "0.0_);(0.0)",
        "_-* #,##0.00_-;-* #,##0.00_-;_-* \"-\"??_-;_-@_-", "0.00_ ;[Red]\\-0.00\\ ", "0.0\" µm\""})
    EXPECT_EQ(note(plain, "Abw. [µm]"), "") << plain;
  EXPECT_EQ(note("0%", "Feuchte [%]"), "");
}

TEST(Workbook, WhatNoCellShowsIsQuoted) {
  const std::string hidden = "<row><c t=\"inlineStr\"><is><t>Soll - Ist</t></is></c><c><v>7</v></c></row>";
  EXPECT_THAT(
      read_workbook(workbook_of("", hidden, "", kRowsOfNumbers, "state=\"hidden\""), "b.xlsx", "").unread,
      testing::ElementsAre("the hidden sheet \"S\" with \"Soll - Ist\""));
  const std::string styles =
      "<fonts><font/><font><strike/></font></fonts><cellXfs><xf fontId=\"0\"/><xf fontId=\"1\"/></cellXfs>";
  const std::string struck = "<row r=\"3\"><c r=\"A3\" s=\"1\"><v>5</v></c><c><v>6</v></c></row>";
  const std::map<std::string, std::string> comment = {
      {"xl/worksheets/_rels/sheet1.xml.rels",
       "<Relationships><Relationship Id=\"rId1\" Type=\"http://x/relationships/comments\" "
       "Target=\"../comments1.xml\"/></Relationships>"},
      {"xl/comments1.xml",
       "<comments><commentList><comment ref=\"B1\"><text><r><t>Werte zehnfach</t></r></text></comment>"
       "</commentList></comments>"}};
  EXPECT_THAT(
      read_workbook(workbook_of("", kRowsOfNumbers + struck, styles, "", "", comment), "b.xlsx", "").unread,
      testing::ElementsAre("the comment of cell B1 \"Werte zehnfach\"", "the struck-out cell A3 \"5\""));
  const std::string header =
      kRowsOfNumbers +
      "</sheetData><headerFooter><oddHeader>&amp;CSoll - Ist</oddHeader><oddFooter>Seite "
      "&amp;P von &amp;N</oddFooter></headerFooter><sheetData>";
  EXPECT_THAT(read_workbook(workbook_of("", header), "b.xlsx", "").unread,
              testing::ElementsAre("the printed header \"Soll - Ist\""));
  EXPECT_THAT(read_workbook(workbook_of("", kRowsOfNumbers), "b.xlsx", "").unread, testing::IsEmpty());
}

TEST(Workbook, AHiddenSheetIsReadOnlyByItsName) {
  const std::string both = workbook_of("", kRowsOfNumbers, "", kRowsOfNumbers, "state=\"hidden\"");
  EXPECT_EQ(read_workbook(both, "b.xlsx", "").name, "T");
  EXPECT_EQ(read_workbook(both, "b.xlsx", "S").name, "S");
  const std::string alone = workbook_of("", kRowsOfNumbers, "", "<row></row>", "state=\"veryHidden\"");
  EXPECT_EQ(
      refusal(alone, ""),
      "b.xlsx: no visible sheet of this workbook contains a cell; hidden sheets are S: to read one, give "
      "--sheet");
}

TEST(Workbook, AMergedCellIsTheValueOfEachOfItsRows) {
  const auto row = [](int number, const std::string& first, const char* second) {
    const std::string at = std::to_string(number);
    return "<row r=\"" + at + "\">" + (first.empty() ? "" : "<c r=\"A" + at + "\">" + first + "</c>") +
           "<c r=\"B" + at + "\"><v>" + second + "</v></c><c r=\"C" + at + "\"><v>7</v></c></row>";
  };
  const std::string rows = row(1, "<v>1</v>", "10") + row(2, "", "20") + row(3, "", "30") + row(4, "", "40");
  const std::string merged = "</sheetData><mergeCells><mergeCell ref=\"A1:A3\"/></mergeCells><sheetData>";
  const WorkbookSheet sheet = read_workbook(workbook_of("", rows + merged), "b.xlsx", "");
  ASSERT_EQ(sheet.rows.size(), 4u);
  EXPECT_EQ(sheet.rows[1][0], "1");
  EXPECT_EQ(sheet.rows[2][0], "1");
  EXPECT_EQ(sheet.rows[3][0], "");
}

TEST(Workbook, AMergedHeadingStaysOneCell) {
  const std::string rows =
      "<row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>X</t></is></c></row>"
      "<row r=\"2\"><c r=\"B2\" t=\"inlineStr\"><is><t>mm</t></is></c></row>";
  const std::string merged = "</sheetData><mergeCells><mergeCell ref=\"A1:A2\"/></mergeCells><sheetData>";
  EXPECT_EQ(read_workbook(workbook_of("", rows + merged), "b.xlsx", "").rows[1][0], "");
}

TEST(Workbook, AFormulaWithoutAValueAmongNumbersIsRefused) {
  const std::string row = "<row r=\"3\"><c><v>1</v></c><c><f>A3*2</f></c></row>";
  EXPECT_EQ(refusal(workbook_of("", row), ""),
            "b.xlsx:3: \"=A3*2\": a formula without a value: the program that wrote the workbook did not "
            "compute it; open the workbook in a spreadsheet program and save it");
  const std::string total =
      "<row><c t=\"inlineStr\"><is><t>Mittelwert</t></is></c><c><f>SUM(B1:B2)</f></c></row>";
  EXPECT_EQ(read_workbook(workbook_of("", kRowsOfNumbers + total), "b.xlsx", "").rows.size(), 3u);
}

TEST(Workbook, TrueAndFalseAreWords) {
  const WorkbookSheet sheet = read_workbook(
      workbook_of("", "<row><c t=\"b\"><v>1</v></c><c t=\"b\"><v>0</v></c></row>"), "b.xlsx", "");
  EXPECT_EQ(sheet.rows[0], (std::vector<std::string>{"TRUE", "FALSE"}));
}

TEST(Workbook, SmallNumbersHaveNoExponent) {
  const WorkbookSheet sheet = read_workbook(
      workbook_of("",
                  "<row><c><v>5.9999999999999995E-4</v></c><c><v>-1.2E-5</v></c><c><v>1E-300</v></c></row>"),
      "b.xlsx", "");
  EXPECT_EQ(sheet.rows[0], (std::vector<std::string>{"0.0006", "-0.000012", "1e-300"}));
}

TEST(Workbook, SheetIsTakenByNameOrNumber) {
  EXPECT_EQ(read_workbook(bytes_of("survey.xlsx"), "b.xlsx", "2").name, "Messung");
  EXPECT_TRUE(read_workbook(bytes_of("survey.xlsx"), "b.xlsx", "Deckblatt").rows.empty());
  EXPECT_EQ(
      refusal(bytes_of("survey.xlsx"), "Tabelle9"),
      "b.xlsx: \"Tabelle9\": the workbook has no sheet of this name; its sheets are Deckblatt, Messung");
}

/// 46085 days are the fourth of March 2026: shown as a date, a date it is.
TEST(Workbook, WhatIsShownAsADateIsADate) {
  const std::string styles =
      "<numFmts><numFmt numFmtId=\"164\" formatCode=\"dd\\.mm\\.yyyy\"/>"
      "<numFmt numFmtId=\"165\" formatCode=\"0.000&quot; mm&quot;\"/>"
      "<numFmt numFmtId=\"166\" formatCode=\"[h]:mm\"/><numFmt numFmtId=\"167\" "
      "formatCode=\"[Red]#,##0.00\"/></numFmts>"
      "<cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"14\"/><xf numFmtId=\"164\"/><xf numFmtId=\"165\"/>"
      "<xf numFmtId=\"166\"/><xf numFmtId=\"167\"/></cellXfs>";
  std::string row = "<row>";
  for (const char* style : {"0", "1", "2", "3", "4", "5", "9"})
    row += std::string("<c s=\"") + style + "\"><v>46085.5</v></c>";
  const WorkbookSheet sheet = read_workbook(workbook_of("", row + "</row>", styles), "b.xlsx", "");
  EXPECT_EQ(sheet.rows.at(0),
            (std::vector<std::string>{"46085.5", "2026-03-04T12:00:00", "2026-03-04T12:00:00", "46085.5",
                                      "2026-03-04T12:00:00", "46085.5", "46085.5"}));
  EXPECT_EQ(date_text(0.5, false), "12:00:00");
  EXPECT_EQ(date_text(1, true), "1904-01-02");
  for (const double serial : {0.5, 1.0, 46085.0, 46085.25}) EXPECT_TRUE(is_date(date_text(serial, false)));
  EXPECT_FALSE(is_date("46085.5"));
}

TEST(Workbook, PrefixedElementsInlineTextAndMissingReferencesAreRead) {
  const WorkbookSheet sheet = read_workbook(bytes_of("prefixed.xlsx"), "b.xlsx", "");
  EXPECT_EQ(sheet.rows[0], (std::vector<std::string>{"X [in]", "", "x [in]"}));
  EXPECT_EQ(sheet.rows[2], (std::vector<std::string>{"2", "", "2"}));
  EXPECT_EQ(sheet.line[2], 3u);
}

TEST(Workbook, NumbersStoredAsTextAndNumbersGetOneDecimalSign) {
  const auto cell = [](const char* type, const char* value) {
    return std::string("<c") + type + "><is><t>" + value + "</t></is><v>" + value + "</v></c>";
  };
  const std::string text = " t=\"inlineStr\"";
  const auto rows_of = [&](const char* first, const char* second) {
    return read_sheet(
        workbook_of("", "<row>" + cell(text.c_str(), "X [mm]") + cell(text.c_str(), "x [mm]") +
                            "</row><row>" + cell("", "100.5") + cell(text.c_str(), first) + "</row><row>" +
                            cell("", "200") + cell(text.c_str(), second) + "</row>"),
        "b.xlsx");
  };
  const Sheet comma = rows_of("100,5045", "200,0095");
  EXPECT_TRUE(comma.decimal_comma);
  EXPECT_FALSE(comma.decimal_doubtful);
  EXPECT_EQ(comma.rows[1], (std::vector<std::string>{"100,5", "100,5045"}));
  const Sheet point = rows_of("100.504", "200.0095");
  EXPECT_FALSE(point.decimal_comma);
  EXPECT_EQ(point.rows[1], (std::vector<std::string>{"100.5", "100.504"}));
  EXPECT_TRUE(rows_of("1,504", "2,009").decimal_doubtful);
  EXPECT_THROW(rows_of("100,5045", "200.0095"), InputError);
}

TEST(Workbook, BrokenFilesAreRefused) {
  const std::string whole = bytes_of("survey.xlsx");
  EXPECT_NE(refusal("PK\x03\x04 and no more", "").find("not a workbook"), std::string::npos);
  for (std::size_t cut = 10; cut < whole.size(); cut += 97)
    EXPECT_NE(refusal(whole.substr(0, cut), ""), "accepted") << cut;
  // Every byte of the directory turned over: refused or read, never a crash.
  for (std::size_t at = whole.size() - 300; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(~changed[at]);
    refusal(changed, "");
  }
}

// Packed they are some kilobytes: runs inside runs ended the program by its stack, cells at the far right by
// its memory.
TEST(Workbook, SmallFilesThatUnpackToAnythingLargeAreRefusedOrRead) {
  std::string nested = "<si>";
  for (int i = 0; i < 500'000; ++i) nested += "<r>";
  nested += "<t>deep</t>";
  for (int i = 0; i < 500'000; ++i) nested += "</r>";
  const std::string one = "<row r=\"1\"><c t=\"s\"><v>1</v></c></row>";
  const WorkbookSheet sheet =
      read_workbook(workbook_of(nested + "</si><si><r><t>a</t></r><t>b</t></si>", one), "b.xlsx", "");
  EXPECT_EQ(sheet.rows[0][0], "ab");
  std::string far;
  for (int i = 1; i <= 2000; ++i) far += "<row><c r=\"XFD" + std::to_string(i) + "\"><v>1</v></c></row>";
  EXPECT_EQ(refusal(workbook_of("", far), ""),
            "b.xlsx:257: \"XFD257\": nearly all cells up to here are empty: the sheet contains no table");
}

}  // namespace
}  // namespace vernier::workbook_test
