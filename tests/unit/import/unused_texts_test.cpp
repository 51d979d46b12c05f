// SPDX-License-Identifier: GPL-3.0-or-later
// Texts beside a table that may change its numbers and that no rule reads.
#include "tools/import/reading/unused_texts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/unit/import/table_reading.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/stated_directions.h"

namespace vernier::unused_texts_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kTable =
    "X soll [mm];dirX;Lauf;Abweichung X "
    "[µm]\n0;1;1;3,5\n70;1;1;9,8\n140;1;1;12,6\n0;1;2;3,9\n70;1;2;9,1\n140;1;2;12,"
    "1\n";
const std::string kRuns = "X [mm];Lauf 1 [µm];Lauf 2 [µm];Lauf 3 [µm];Lauf 4 [µm]\n0;1;2;1;2\n50;3;4;3;4\n";

TEST(UnusedTexts, OfTheSignAndOfIncrementsAreRefused) {
  for (const char* text : {"Positive Werte bedeuten, dass der Schlitten vor dem Ziel stehen bleibt.",
                           "Minus indicates overtravel.", "Positiver Wert: Position nicht erreicht",
                           "Values are the amounts to be added to the commanded position.",
                           "Kompensationswerte für die Steuerung", "Zu wenig Weg = +"}) {
    EXPECT_THAT(read(std::string(text) + "\n" + kTable),
                AllOf(StartsWith("refused: "), HasSubstr("--sign actual-nominal or --sign nominal-actual")))
        << text;
    SheetWords words;
    words.sign = "nominal-actual";
    EXPECT_THAT(read(std::string(text) + "\n" + kTable, words), HasSubstr("\n0,1,1,-0.0035\n")) << text;
  }
  EXPECT_THAT(read("Angegeben ist jeweils die Änderung gegenüber der vorigen Zeile.\n" + kTable),
              AllOf(StartsWith("refused: "), HasSubstr("are increments"), HasSubstr("--deviation")));
}

TEST(UnusedTexts, OfOtherSubjectsHaveANoteWithTheChangeToMake) {
  for (const auto& [text, note] :
       {std::pair("angezeigte Werte sind doppelt so groß wie die Abweichung", "may state a factor"),
        std::pair("The values must be halved (double pass interferometer).", "may state a factor"),
        std::pair("Anzeige = 2 x Abweichung", "may state a factor"),
        std::pair("100 µm zu jedem Wert addiert", "a number was added"),
        std::pair("Lauf 2 verworfen (Stoß gegen das Stativ)", "readings are not valid"),
        std::pair("Nullpunkt der Liste liegt bei X = 150 mm", "another zero point"),
        std::pair("Maschinenkoordinate = Pos + 120 mm", "another zero point"),
        std::pair("Positionen in Zoll", "write [in] in place of the unit"),
        std::pair("Spalte 2 ist in Zehntel Mikrometer zu verstehen.", "write [0.1um] in place of the unit"),
        std::pair("Date: 3 Nov 2026, displayed in tenths of a micron", "write [0.1um] in place of the unit"),
        std::pair("Die zweite Spalte wurde beim Rücklauf notiert, also beginnend am fernen Ende.",
                  "reverse the order of the values")}) {
    EXPECT_THAT(
        read(std::string(text) + "\n" + kTable),
        AllOf(StartsWith("X[mm],"), HasSubstr(std::string("line 1: the text \"") + text), HasSubstr(note)))
        << text;
    EXPECT_THAT(read(kTable + "\n" + text + "\n"), HasSubstr(note)) << text;
    EXPECT_THAT(read(std::string("# ") + text + "\n" + kTable), HasSubstr(note)) << text;
  }
  EXPECT_THAT(
      read("X [mm];dirX;Abweichung X [µm];Bemerkung\n0;1;1,0;\n50;1;2,0;Messuhr neu genullt\n100;1;3,0;\n"),
      HasSubstr("line 3: the text \"Messuhr neu genullt\" may state another zero point"));
}

TEST(UnusedTexts, ThatNoRuleKnowsAreQuotedInOneNote) {
  for (const char* text :
       {"Den vierten Durchlauf bitte nicht mitnehmen.",
        "Prüfer: K. Lenz (notiert, um wie viel nachzustellen ist)",
        "Temperatur 20,1 °C - Ausgabe des Lasers in Nanometern",
        "Standard: ISO 230-2, figures as fed to the control", "Messgerät: Laser XL-80, Zählrichtung gedreht",
        "Temperatur: 20,3 °C, Werte noch ohne Ausdehnungskorrektur"}) {
    EXPECT_THAT(read(std::string(text) + "\n" + kTable),
                HasSubstr(std::string("note: beside the table: line 1 \"") + text + "\". Does one of these"))
        << text;
    const std::string below = read(kTable + "\n" + text + "\n");
    EXPECT_THAT(below, HasSubstr(std::string("\"") + text + "\". Does one of these")) << text;
    EXPECT_THAT(below, Not(HasSubstr("is omitted"))) << text;
  }
  EXPECT_THAT(
      read("Lauf 2: zurück, vom anderen Ende her notiert\nX [mm];Lauf 1 + [µm];Lauf 2 - [µm]\n0;1;2\n50;"
           "3;4\n100;5;6\n"),
      HasSubstr("vom anderen Ende her notiert"));
  std::string many;
  for (int k = 0; k < 20; ++k) many += "# Feld" + std::to_string(k) + "\n";
  EXPECT_THAT(read("# Das hier ist bitte von hinten zu sehen\n" + many + kTable),
              AllOf(HasSubstr("line 1 \"Das hier ist bitte von hinten zu sehen\""),
                    HasSubstr(" and 9 shorter texts")));
}

TEST(UnusedTexts, OfAProtocolMakeNoClaim) {
  for (const char* text : {"Positioniergenauigkeit X-Achse, Laser XL-80, 20 °C, Bediener Müller",
                           "Positioning accuracy test according to ISO 230-2:2014, bidirectional, 5 runs",
                           "Overrun 5 mm, dwell 2 s",
                           "Bediener: Schmidt, Datum: 12.05.2026, Uhrzeit 08:30",
                           "Anzahl Läufe: 5, Anfahrten je Position: 5",
                           "Temperaturkompensation aktiv, Ausdehnungskoeffizient 11,7 µm/m/K",
                           "Messung nach Kompensation",
                           "Kompensation ausgeschaltet",
                           "Messuhr Mahr 1087, Auflösung 0,001 mm",
                           "Laser genullt bei X = 0",
                           "Warm-up: half an hour at 3000 rpm",
                           "Coverage factor k = 2",
                           "Alle Messungen gültig",
                           "Keine Ausreißer",
                           "Wiederholbarkeit und Umkehrspanne nach VDI/DGQ 3441",
                           "Messung in positiver und negativer Richtung",
                           "Gewindetrieb 10 mm Steigung, Übersetzung 1:1",
                           "Seite 1 von 2",
                           "Alle Werte sind in µm angegeben.",
                           "Die Messung wurde von Herrn Schmidt durchgeführt.",
                           "Messung vorwärts und rückwärts nach ISO 230-2"})
    EXPECT_THAT(read(std::string(text) + "\n" + kTable),
                AllOf(StartsWith("X[mm],"), Not(HasSubstr("may state")), Not(HasSubstr("names the unit"))))
        << text;
}

TEST(StatedDirections, OfRunsAgainstTheOthers) {
  for (const char* text :
       {"Jeder zweite Lauf wurde in Gegenrichtung gefahren.",
        "The even-numbered runs are the return strokes.", "Nach jedem Lauf wurde die Richtung gewechselt.",
        "Läufe 2 und 4 in Gegenrichtung"})
    EXPECT_THAT(read(std::string(text) + "\n" + kRuns),
                AllOf(HasSubstr("1+, 2-, 3+, 4-"), HasSubstr("taken as forward")))
        << text;
  for (const char* text : {"Columns 1-2 approached from below, columns 3-4 from above.",
                           "Die ersten beiden Spalten vorwärts, die letzten beiden rückwärts"})
    EXPECT_THAT(read(std::string(text) + "\n" + kRuns), HasSubstr("1+, 2+, 3-, 4-")) << text;
  // Three and two are not four.
  EXPECT_THAT(read("Die ersten drei Spalten vorwärts, die letzten beiden rückwärts\n" + kRuns),
              HasSubstr("does not state that of each run"));
}

TEST(StatedDirections, OfCodesAreThoseOfTheText) {
  EXPECT_THAT(
      read("dirX: -1 = vorwärts, 1 = rückwärts\nX [mm];dirX;Abweichung X [µm]\n0;-1;1\n50;-1;2\n0;1;5\n"),
      AllOf(StartsWith("X[mm],dirX,x[mm]\n0,1,0.001\n50,1,50.002\n0,-1,0.005\n"),
            HasSubstr("states the codes of \"dirX\"")));
  EXPECT_THAT(read("a = rückwärts, b = vorwärts\nX [mm];Richtung;Abweichung X [µm]\n0;b;1\n50;b;2\n0;a;5\n"),
              StartsWith("X[mm],dirX,x[mm]\n0,1,0.001\n50,1,50.002\n0,-1,0.005\n"));
}

TEST(BackOrder, FromTheBottomToTheTop) {
  const std::string table = "X [mm];hin [µm];zurück [µm]\n0;1;7\n50;2;8\n100;3;9\n";
  for (const char* text :
       {"Spalte zurück von unten nach oben lesen", "Rückweg: der oberste Wert gehört zur letzten Position"})
    EXPECT_THAT(read(std::string(text) + "\n" + table),
                HasSubstr("\n100,-1,1,100.007\n50,-1,1,50.008\n0,-1,1,0.009\n"))
        << text;
}

TEST(UnusedColumns, TwoColumnsOfDeviationsAreNotReadAsOne) {
  EXPECT_THAT(read("X [mm];Weg zurück [µm];Weg hin [µm]\n0;-1;3\n70;4;9\n140;8;12\n210;9;13\n"),
              AllOf(StartsWith("refused: "), HasSubstr("would read one of these columns only"),
                    Not(HasSubstr("--deviation \""))));
  EXPECT_THAT(
      read("Nr;Sollw. X [mm];Istw. X [mm];Diff. [µm]\n1;0;0,0036;-3,6\n2;70;70,0095;-9,5\n3;140;140,0123;"
           "-12,3\n4;210;210,0130;-13,0\n"),
      AllOf(HasSubstr("70,70.0095"), HasSubstr("is the difference between")));
  EXPECT_THAT(read("X [mm];dirX;Abweichung X [µm];U [µm]\n0;1;3;1,8\n70;1;4;1,8\n"),
              HasSubstr("if it is the expanded uncertainty, write U (k=2)"));
  EXPECT_THAT(read("X [mm];Nicken um Y [µm/m]\n0;3\n70;4\n"), HasSubstr("--column \"ry[urad]=Nicken um Y"));
  EXPECT_THAT(read("X [mm];Abweichung X [µm]\n'0,00;'3,9\n'70,00;'9,7\n"),
              HasSubstr("delete the apostrophes"));
}

}  // namespace
}  // namespace vernier::unused_texts_test
