// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/workbook.h"

#include <gtest/gtest.h>

#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::workbook_test {
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

TEST(Workbook, SheetIsTakenByNameOrNumber) {
  EXPECT_EQ(read_workbook(bytes_of("survey.xlsx"), "b.xlsx", "2").name, "Messung");
  EXPECT_TRUE(read_workbook(bytes_of("survey.xlsx"), "b.xlsx", "Deckblatt").rows.empty());
  EXPECT_EQ(refusal(bytes_of("survey.xlsx"), "Tabelle9"),
            "b.xlsx: \"Tabelle9\": no sheet of this name; there are Deckblatt, Messung");
}

TEST(Workbook, PrefixedElementsInlineTextAndMissingReferencesAreRead) {
  const WorkbookSheet sheet = read_workbook(bytes_of("prefixed.xlsx"), "b.xlsx", "");
  EXPECT_EQ(sheet.rows[0], (std::vector<std::string>{"X [in]", "", "x [in]"}));
  EXPECT_EQ(sheet.rows[2], (std::vector<std::string>{"2", "", "2"}));
  EXPECT_EQ(sheet.line[2], 3u);
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

}  // namespace
}  // namespace vernier::workbook_test
