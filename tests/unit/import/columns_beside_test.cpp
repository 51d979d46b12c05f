// SPDX-License-Identifier: GPL-3.0-or-later
// Words of headings, columns and cells that no rule reads, beside the readings of a table.
#include "tools/import/columns/columns_beside.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"
#include "tools/import/words/sign_words.h"
#include "tools/import/words/unread_words.h"

namespace vernier::columns_beside_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

/// A table of an axis with these two headings, and one more column with these cells.
std::string table_of(const std::string& position, const std::string& deviation,
                     const std::string& heading = "", const std::string& first = "",
                     const std::string& others = "") {
  const std::string end = heading.empty() ? "" : ";" + heading;
  std::string text = position + ";" + deviation + ";Richtung" + end + "\n";
  const std::string rows[] = {"0;3,3;vor", "70;6,4;vor", "140;8,4;vor", "140;2,4;rück", "70;0,1;rück"};
  for (const std::string& row : rows)
    text += row + (heading.empty() ? "" : ";" + (&row == rows ? first : others)) + "\n";
  return text;
}

TEST(HeadingWords, ThatNoRuleReadsAreQuoted) {
  const auto note = [](const std::string& heading, const std::string& words) {
    return "note: of the heading \"" + heading + "\" the import does not use \"" + words + "\": if this ";
  };
  for (const auto& [heading, words] :
       {std::pair("Abweichung X [µm] zehnfach", "zehnfach"), std::pair("halbe Abweichung X [µm]", "halbe"),
        std::pair("Abweichung X, doppelter Wert [µm]", "doppelter"),
        std::pair("Abweichung X [µm] + 10", "+ 10"),
        std::pair("Abweichung X gegensinnig [µm]", "gegensinnig"),
        std::pair("negative Abweichung X [µm]", "negative"), std::pair("-Abweichung X [µm]", "-Abweichung"),
        std::pair("Abweichung -X [µm]", "-X"),
        std::pair("Abweichung X [µm] Skalenteil 0,5", "Skalenteil 0 5"),
        std::pair("Abweichung X (Spitze-Spitze) [µm]", "Spitze Spitze")})
    EXPECT_THAT(read(table_of("X Soll [mm]", heading)),
                AllOf(StartsWith("X[mm],"), HasSubstr(note(heading, words))))
        << heading;
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm] (S-I)")), HasSubstr("does not use \"S I\""));
  for (const auto& [heading, words] : {std::pair("X Soll [mm] (ab Nullpunkt 100)", "ab Nullpunkt 100"),
                                       std::pair("X Soll [mm] von rechts", "rechts")})
    EXPECT_THAT(read(table_of(heading, "Abweichung X [µm]")), HasSubstr(note(heading, words))) << heading;
}

TEST(HeadingWords, OfOrdinaryHeadingsAreRead) {
  for (const char* heading :
       {"Abweichung X [µm]", "Abw. X (Ist-Soll) [µm]", "X-Abweichung in µm", "Positionsabweichung X [µm]",
        "Abweichung der X-Achse [µm]", "Deviation X [um]", "X error (um)", "Laser error X [um]", "dX [µm]",
        "\u0394X [µm]", "Abweichung X 0,001 mm", "Fehler X [1/1000 mm]", "Abweichung X in Mikrometer",
        "Écart X [µm]"})
    EXPECT_THAT(read(table_of("X Soll [mm]", heading)), Not(HasSubstr("of the heading"))) << heading;
  for (const char* heading :
       {"X [mm]", "Sollposition X [mm]", "Target X (mm)", "X_soll [mm]", "X-Achse Soll [mm]"})
    EXPECT_THAT(read(table_of(heading, "Abweichung X [µm]")), Not(HasSubstr("of the heading"))) << heading;
  EXPECT_THAT(
      read("X [mm];Lauf 1 hin [µm];Lauf 1 rück [µm];Lauf 2 hin [µm];Lauf 2 rück [µm]\n0;1;2;1;2\n50;3;"
           "4;3;4\n"),
      Not(HasSubstr("of the heading")));
  EXPECT_THAT(unread_words("Lauf 2 rück", {true, true}), IsEmpty());
  EXPECT_THAT(unread_words("Lauf 2 rück mal 5", {true, true}), ElementsAre("mal"));
}

TEST(ColumnsBeside, SayWhichRowsCount) {
  for (const auto& [heading, bad, good] :
       {std::tuple("verwenden", "nein", "ja"), std::tuple("Messung gültig", "0", "1"),
        std::tuple("Status", "ERR", "OK"), std::tuple("nicht verwenden", "ja", "nein"),
        std::tuple("gültig", "", "x")})
    EXPECT_THAT(
        read(table_of("X Soll [mm]", "Abweichung X [µm]", heading, bad, good)),
        AllOf(HasSubstr("line 2: this row says \"" + std::string(heading) + ": "), Not(HasSubstr("\n0,"))))
        << heading;
  // A verdict about the tolerance, and words without a certain meaning, leave out no row.
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Status", "n.i.O.", "i.O.")),
              HasSubstr("\n0,"));
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Status", "3", "0")),
              AllOf(HasSubstr("\n0,"), HasSubstr("column \"Status\" (\"3\" in 1 row, \"0\" in 4 rows)")));
}

TEST(ColumnsBeside, ThatAreNotReadAreNamed) {
  for (const auto& [heading, cell] :
       {std::pair("Faktor", "0,5"), std::pair("Einheit", "1/10 µm"), std::pair("Offset [µm]", "5,0"),
        std::pair("Bemerkung", "blieb zurück")})
    EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", heading, cell, cell)),
                HasSubstr("note: beside the readings: column \"" + std::string(heading) + "\" (\"" + cell +
                          "\" in 5 rows). No reading is changed"))
        << heading;
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Öl [°C]", "20,1", "20,2")),
              Not(HasSubstr("beside the readings")));
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Lauf", "1", "1")),
              Not(HasSubstr("beside the readings")));
}

TEST(ColumnsBeside, AVerdictNamesTheRowsThatDiffer) {
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Status", "NIO", "IO")),
              HasSubstr("line 2 has \"NIO\": if a row there does not count, delete it in the file"));
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "ok", "", "x")),
              HasSubstr("line 2 is empty there: if a row"));
  EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]", "Status", "IO", "IO")),
              Not(HasSubstr("if a row there does not count")));
}

TEST(ColumnsBeside, AReversalErrorWithoutTheWayBackIsNotComputedFromTheOthers) {
  const auto why = [](const std::string& text) {
    const SheetReading reading = read_as_sheet(text, "s.csv", {});
    return reading.columns.back().why;
  };
  EXPECT_THAT(
      why("X Soll [mm];Abweichung vor [µm];Umkehrspanne [µm]\n0;3,3;-14\n70;6,4;-14\n140;7;-14\n"),
      AllOf(HasSubstr("\"Abweichung vor [µm]\" has one direction: no other column shows the way back"),
            HasSubstr("--set \"dirX=1\"")));
  EXPECT_THAT(
      why("X Soll [mm];Richtung;Abweichung X [µm];Umkehrspanne [µm]\n0;+;3,3;-14\n70;+;6,4;-14\n"
          "70;-;20,4;-14\n0;-;17,3;-14\n"),
      AllOf(HasSubstr("computed from the readings in the other columns"), Not(HasSubstr("the way back"))));
}

TEST(ColumnsBeside, ALetterOfTwoBytesStaysWhole) {
  EXPECT_THAT(unread_words("Abweichung X µm · 10", {}), ElementsAre("10"));
  EXPECT_THAT(unread_words("Abweichung µA·zehn", {}), ElementsAre("µA", "zehn"));
  EXPECT_THAT(read("Position X;Abweichung X\nmm;µm (minus = zu weit)\n0;3,3\n70;6,4\n"),
              HasSubstr("\n0,-0.0033"));
}

TEST(ColumnsBeside, RunsInRowsAreATransposedTable) {
  const std::string title = "X-Achse, Abweichungen in µm, Positionen in mm\n";
  EXPECT_THAT(read(title + "Lauf;0;50;100\n1 vor;-13,1;-8,6;-8,5\n1 rück;1,4;4,9;5,7\n2 vor;-13;-8;-8\n"),
              HasSubstr("each row below is one run: the table is transposed"));
  EXPECT_THAT(read(title + "1 vor;0;50;100\n1 rück;0;50;100\n2 vor;0;50;100\n"),
              Not(HasSubstr("transposed")));
}

TEST(ColumnsBeside, TheDirectionsMayBeWordsForHeights) {
  EXPECT_THAT(read("X Soll [mm];Richtung;Abweichung X [µm]\n0;aufwärts;3,3\n70;aufwärts;6,4\n70;abwärts;7\n"
                   "0;abwärts;2\n"),
              AllOf(HasSubstr("\n70,1,"), HasSubstr("\n70,-1,")));
}

TEST(ColumnsBeside, ASignOfOneDirectionHasNoOptionForAllReadings) {
  EXPECT_THAT(read("Abweichungen in µm; Spalten rück: bereits mit umgekehrtem Vorzeichen\n"
                   "Position X [mm];1 vor;1 rück\n0;0,1;-6,2\n50;4,4;-10,2\n100;4;-10\n"),
              AllOf(HasSubstr("another sign for the readings of one direction (rück)"),
                    HasSubstr("reverse these values in the file; then delete this text"),
                    Not(HasSubstr("give --sign"))));
}

TEST(ColumnsBeside, ATextAboutTheSignBetweenTheRowsIsNotOnlyDeleted) {
  EXPECT_THAT(read("Position X [mm];Lauf;Abweichung X [µm]\n0;1;3\n70;1;6\nab hier Soll minus "
                   "Ist;;\n0;2;-3\n70;2;-6\n"),
              HasSubstr("reverse their values in the file before you delete the text"));
}

TEST(ColumnsBeside, NamesOfRunsAndPointsOfAnotherFormAreQuoted) {
  const auto table = [](const std::string& heading, const std::vector<std::string>& names) {
    std::string text = "X Soll [mm];Richtung;" + heading + ";Abweichung X [µm]\n";
    for (std::size_t i = 0; i < names.size(); ++i)
      for (const char* const row : {"0;+;", "70;+;"}) text += row + names[i] + ";" + std::to_string(i) + "\n";
    return text;
  };
  for (const char* const odd :
       {"Probelauf", "1 (Einfahren)", "Test", "2*", "Warmlauf", "dry run", "2 umgekehrt"}) {
    EXPECT_THAT(read(table("Lauf", {odd, "2", "3"})),
                HasSubstr("note: column \"Lauf\": \"" + std::string(odd) +
                          "\" in 2 rows (the others: 2, 3). Are these rows valid readings?"));
  }
  EXPECT_THAT(read(table("Lauf", {"Probelauf", "Hauptlauf"})), HasSubstr("\"Probelauf\" in 2 rows"));
  EXPECT_THAT(read(table("Punkt", {"P0", "P1", "P2 n. verw.", "P3"})),
              HasSubstr("column \"Punkt\": \"P2 n. verw.\" in 2 rows (the others: P0, P1, P3)"));
  for (const std::vector<std::string>& usual : {std::vector<std::string>{"1", "2", "3"},
                                                {"S1", "S2", "3"},
                                                {"forward", "back", "1"},
                                                {"1 vor", "2 vor", "1 zurück"},
                                                {"Serie 1", "Serie 2", "Serie 3"},
                                                {"kalt", "warm", "heiß"},
                                                {"Lauf 1", "Lauf 2", "3"},
                                                {"A", "B", "1"},
                                                {"Test 1", "Test 2", "Test 3"}})
    EXPECT_THAT(read(table("Lauf", usual)), Not(HasSubstr("Are these rows valid"))) << usual.front();
}

TEST(ColumnsBeside, TextsRightOfTheHeadingsAreTextsOfTheTable) {
  EXPECT_THAT(read("X Soll [mm];Abweichung X [µm];;Vorzeichen: Soll - Ist\n0;3,3;;\n70;6,4;;\n"),
              AllOf(HasSubstr("\n0,-0.0033"), HasSubstr("by the text \"Vorzeichen: Soll - Ist\"")));
  EXPECT_THAT(read("X Soll [mm];Abweichung X [µm];;Skalenfaktor;0,5\n0;3,3;;;\n70;6,4;;;\n"),
              HasSubstr("line 1: the text \"Skalenfaktor, 0,5\" may state a factor"));
}

TEST(SignTexts, OfTheUsualSignAreHarmless) {
  for (const char* text :
       {"Vorzeichen geprüft und in Ordnung", "Vorzeichenregel nach ISO 230-1",
        "No sign change was necessary.", "Messuhr in Achsrichtung montiert, Vorzeichen unverändert",
        "The laser counts in the direction of the axis, sign checked by moving 1 mm"})
    EXPECT_TRUE(says_sign_is_usual(text)) << text;
  for (const char* text :
       {"Vorzeichen umgekehrt, geprüft", "sign checked: plus is short", "Vorzeichen nicht geprüft",
        "Vorzeichen geprüft: Soll - Ist", "sign changed before the export", "Vorzeichenwechsel nach ISO",
        "Vorzeichen falsch"})
    EXPECT_FALSE(says_sign_is_usual(text)) << text;
  const std::string table = table_of("X Soll [mm]", "Abweichung X [µm]");
  EXPECT_THAT(read(table + "Die Abweichung ist Ist - Soll, nicht Soll - Ist.\n"),
              HasSubstr("\n0,0.0033,1\n"));
  EXPECT_THAT(read(table + "Die Abweichung ist Soll - Ist, nicht Ist - Soll.\n"),
              HasSubstr("\n0,-0.0033,1\n"));
  EXPECT_THAT(read(table + "No sign change was necessary.\n"),
              AllOf(HasSubstr("\n0,0.0033,1\n"), HasSubstr("\"No sign change was necessary.\"")));
  EXPECT_THAT(read(table + "Compensation values will be computed by the service\n"),
              HasSubstr("\n0,0.0033,1\n"));
  // The heading outranks a doubtful text, which is quoted.
  EXPECT_THAT(
      read(table_of("X Soll [mm]", "Abweichung X [µm] (Ist minus Soll)") + "Vorzeichen wie besprochen\n"),
      AllOf(HasSubstr("\n0,0.0033,1\n"), HasSubstr("beside the table: line 7 \"Vorzeichen wie")));
  EXPECT_THAT(read(table + "Vorzeichen wie besprochen\n"), StartsWith("refused: "));
}

TEST(SignTexts, OfOneRowAndSumsHaveTheirOwnMend) {
  EXPECT_THAT(
      read(table_of("X Soll [mm]", "Abweichung X [µm]", "Bemerkung", "ab hier Vorzeichen gedreht", "")),
      AllOf(StartsWith("refused: s.csv:2: "), HasSubstr("reverse the sign of these values in the file")));
  for (const char* text : {"Zu allen Werten sind 12 µm zu addieren (Vorspannung der Uhr)",
                           "die Tabelle der Steuerung (0,02 µm/mm) ist abzuziehen"})
    EXPECT_THAT(read(table_of("X Soll [mm]", "Abweichung X [µm]") + text + "\n"),
                AllOf(StartsWith("X[mm],"), HasSubstr("subtract (or add) the number in the file")))
        << text;
}

TEST(SignTexts, OfDistancesAreReadAsThoseOfAxes) {
  SheetWords words;
  words.points.points = {
      {"A", {0, 0, 0}, {0, 0, 0}}, {"B", {150, 0, 0}, {150, 0, 0}}, {"C", {150, 150, 0}, {150, 150, 0}}};
  const auto rows = [](const std::string& heading) {
    return "Strecke;Soll [mm];" + heading + "\nAB;150;-0,13\nBC;150;0,06\nAC;212,13;0,10\n";
  };
  EXPECT_THAT(read(rows("Abweichung [mm]"), words), HasSubstr("149.87"));
  EXPECT_THAT(read(rows("Abweichung [mm]") + "Abweichung = Soll - Ist\n", words),
              AllOf(HasSubstr("150.13"), HasSubstr("by the text \"Abweichung = Soll - Ist\"")));
  EXPECT_THAT(read(rows("Korrektur [mm]"), words), HasSubstr("150.13"));
  words.columns = {"deviation[mm]=Korrektur [mm]"};
  EXPECT_THAT(read(rows("Korrektur [mm]"), words), HasSubstr("150.13"));
  words.sign = "actual-nominal";
  EXPECT_THAT(read(rows("Korrektur [mm]"), words), HasSubstr("149.87"));
}

}  // namespace
}  // namespace vernier::columns_beside_test
