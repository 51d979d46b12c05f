// SPDX-License-Identifier: GPL-3.0-or-later
// Quotes that are alone in their cell, and quotes that are not closed.
#include "tools/sheet/ditto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::ditto_test {

using namespace vernier::sheet;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace {

using Row = std::vector<std::string>;

Sheet read(const std::string& text) { return read_sheet(text, "s.csv"); }

std::string refusal_of(const std::string& text) {
  try {
    read(text);
  } catch (const text::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Ditto, AMarkRepeatsTheCellAboveIt) {
  const Sheet sheet = read("Lauf;X;x\n1;0;0,0\n\";50;3,2\n\";100;-1,5\n2;0;0,4\n\";50;3,3\n");
  ASSERT_EQ(sheet.rows.size(), 6u);
  EXPECT_EQ(sheet.rows[2], (Row{"1", "50", "3,2"}));
  EXPECT_EQ(sheet.rows[3], (Row{"1", "100", "-1,5"}));
  EXPECT_EQ(sheet.rows[5], (Row{"2", "50", "3,3"}));
  EXPECT_THAT(sheet.notes, ElementsAre("3 ditto marks such as \" in line 3 repeat the cells above them"));
}

TEST(Ditto, AMarkAtTheEndOfALineTakesNoRow) {
  const Sheet sheet = read("X;x;Bem\n0;0,0;gut\n50;3,2;\"\n100;-1,5;\"\n150;4,8;\n");
  ASSERT_EQ(sheet.rows.size(), 5u);
  EXPECT_EQ(sheet.rows[2], (Row{"50", "3,2", "gut"}));
  EXPECT_EQ(sheet.rows[3], (Row{"100", "-1,5", "gut"}));
  EXPECT_EQ(sheet.rows[4].back(), "");
}

TEST(Ditto, MarksBetweenBlanksAndInTwoColumns) {
  EXPECT_EQ(read("Lauf  X  x\n1  0  0,0\n\"  50  1,1\n\"  100  1,4\n").rows[3], (Row{"1", "100", "1,4"}));
  EXPECT_EQ(read("Lauf;Art;X;x\n1;a;0;0,0\n\";\";50;1,1\n\";\";9;1,4\n").rows[3],
            (Row{"1", "a", "9", "1,4"}));
}

TEST(Ditto, CellsInQuotesStayWhole) {
  const Sheet sheet = read("X;\"x,\nmeasured\"\n0;\"0,5\"\n1;\"1,5\"\n");
  EXPECT_EQ(sheet.rows[0], (Row{"X", "x, measured"}));
  EXPECT_THAT(sheet.notes, IsEmpty());
  EXPECT_EQ(read("X,x\n\"0\",\",5\"\n\"1\",\"1,5\"\n").rows[1], (Row{"0", ",5"}));
  EXPECT_EQ(read("Note;X\n3\" gauge;0\n\"\";1\n").rows[1], (Row{"3\" gauge", "0"}));
}

TEST(Ditto, AQuoteNeverTakesARowOfNumbers) {
  EXPECT_THAT(refusal_of("X;x;Bem\n0;0,0;ok\n50;1,1;\"gut\n100;1,5;gut\"\n"),
              HasSubstr("s.csv:3: \"gut\": a closing quote is missing: write it, or delete the quote"));
  EXPECT_THAT(refusal_of("Lauf;X;x\n\";0;0,0\n\";50;3,2\n"),
              HasSubstr("s.csv:2: \"\"\": this is a ditto mark, and no row of numbers is above it"));
}

}  // namespace
}  // namespace vernier::ditto_test
