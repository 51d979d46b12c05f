// SPDX-License-Identifier: GPL-3.0-or-later
// Facts that a text beside a table states in words: directions of the runs, the order of the readings of the
// way back, increments, the sense of an instrument.
#include "tools/import/words/stated_directions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/import/table_reading.h"

namespace vernier::stated_order_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kRuns = "X [mm];Lauf 1 [µm];Lauf 2 [µm]\n0;1;2\n50;3;4\n100;5;6\n";
const std::string kAlternating =
    "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.003\n100,1,1,100.005\n100,-1,2,100.006\n50,-1,2,50.004\n"
    "0,-1,2,0.002\n";
const std::string kUndirected =
    "X[mm],run,x[mm]\n0,1,0.001\n50,1,50.003\n100,1,100.005\n0,2,0.002\n50,2,50.004\n100,2,100.006\n";

TEST(StatedDirections, AreThoseOfTheRunsByATextAtAnyPlace) {
  for (const char* text :
       {"Laserprotokoll, abwechselnd vor und zurück gefahren", "Läufe im Wechsel hin und her",
        "Laser, runs alternating forth and back", "measured alternately forward and backward",
        "ungerade Läufe vorwärts, gerade Läufe rückwärts", "Odd runs forward, even runs backward",
        "Lauf 1 vorwärts, Lauf 2 rückwärts", "vorwärts: Lauf 1, rückwärts: Lauf 2"}) {
    const std::string line = std::string(text) + "\n";
    EXPECT_THAT(read(line + kRuns), AllOf(StartsWith(kAlternating),
                                          HasSubstr("states the approach directions of the runs: 1+, 2-")))
        << text;
    EXPECT_THAT(read(kRuns + line), StartsWith(kAlternating)) << text;
    EXPECT_THAT(read("# " + line + kRuns), StartsWith(kAlternating)) << text;
  }
}

TEST(StatedDirections, OfTheFirstRunAreTheFirstInTheText) {
  EXPECT_THAT(
      read("abwechselnd rückwärts und vorwärts gemessen\n" + kRuns),
      StartsWith("X[mm],dirX,run,x[mm]\n100,-1,1,100.005\n50,-1,1,50.003\n0,-1,1,0.001\n0,1,2,0.002\n"));
}

TEST(StatedDirections, OfRangesAndListsOfRuns) {
  const StatedDirections range = directions_stated("Läufe 1-3 vorwärts, Läufe 4 bis 6 rückwärts");
  EXPECT_EQ(range.of(3), 1);
  EXPECT_EQ(range.of(4), -1);
  EXPECT_EQ(range.of(5), -1);
  EXPECT_EQ(range.of(7), 0);
  const StatedDirections list = directions_stated("Runs 1, 3 forward; runs 2, 4 back");
  EXPECT_EQ(list.of(3), 1);
  EXPECT_EQ(list.of(4), -1);
}

TEST(StatedDirections, ATextThatDoesNotStateEachRunGetsANote) {
  for (const char* text : {"Läufe mit abwechselnder Richtung", "2 Läufe vorwärts, 2 Läufe rückwärts"})
    EXPECT_THAT(read(std::string(text) + "\n" + kRuns),
                AllOf(StartsWith(kUndirected), HasSubstr("does not state that of each run")))
        << text;
  EXPECT_THAT(read("unidirektional gemessen\n" + kRuns),
              AllOf(StartsWith(kUndirected), HasSubstr("give --set dirX=1, or --set dirX=-1")));
}

TEST(StatedDirections, OtherTextsStateNone) {
  for (const char* text :
       {"Messung nur vor der Kompensation", "alle Abweichungen: positiv = Ist größer als Soll",
        "Hinweis: Läufe am 12.05.2026", "Tisch vor jedem Lauf entlüftet"})
    EXPECT_THAT(read(std::string(text) + "\n" + kRuns),
                AllOf(StartsWith(kUndirected), Not(HasSubstr("direction"))))
        << text;
}

TEST(StatedDirections, HeadingsAndOptionsAreBeforeTheText) {
  EXPECT_THAT(
      read("abwechselnd rückwärts und vorwärts\nX [mm];Lauf 1+ [µm];Lauf 1- [µm]\n0;1;2\n50;3;4\n100;5;6\n"),
      AllOf(StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n"), Not(HasSubstr("the text"))));
  SheetWords words;
  words.constants = {"dirX=1"};
  EXPECT_THAT(read("abwechselnd vor und zurück\n" + kRuns, words), HasSubstr("0,2,0.002,1\n"));
}

TEST(StatedDirections, ApplyToTheRunsOfATableWithOneRowForEachReading) {
  EXPECT_THAT(
      read("Läufe abwechselnd vor und zurück\nLauf;X [mm];Abweichung [µm]\n1;0;1\n1;50;3\n1;100;5\n2;100;6\n"
           "2;50;4\n2;0;2\n"),
      AllOf(HasSubstr("2,100,100.006,-1\n"), HasSubstr("1,50,50.003,1\n")));
}

TEST(StatedDirections, HeadingsMayBeTheNumbersOfTheRunsAlone) {
  EXPECT_THAT(
      read("Abweichungen in µm, Läufe 1 und 3 vorwärts, 2 und 4 rückwärts\nX [mm];1;2;3;4\n0;1;2;3;4\n"
           "50;5;6;7;8\n100;9;10;11;12\n"),
      StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.005\n100,1,1,100.009\n100,-1,2,100.01\n"));
}

const std::string kBack = "Soll X [mm];vor [µm];zurück [µm]\n0;1;6\n50;3;4\n100;5;2\n";

TEST(BackOrder, ReadingsInTheOrderOfTheMeasurementAreReversed) {
  for (const char* text :
       {"Werte zurück in der Reihenfolge der Messung (von 100 nach 0)", "Rücklauf: Werte in Messreihenfolge",
        "Values back in the order of measurement (from 100 to 0)"})
    EXPECT_THAT(read(std::string(text) + "\n" + kBack),
                AllOf(HasSubstr("100,1,1,100.005\n100,-1,1,100.006\n50,-1,1,50.004\n0,-1,1,0.002\n"),
                      HasSubstr("are in the order of their measurement")))
        << text;
}

TEST(BackOrder, ATextBetweenTheHeadingsAndTheRowsIsNoHeading) {
  const std::string head = "Soll X [mm];vor [µm];zurück [µm]\n";
  EXPECT_THAT(read(head + "Werte zurück in der Reihenfolge der Messung (von 100 nach 0)\n" +
                   kBack.substr(head.size())),
              AllOf(StartsWith("X[mm],dirX,run,x[mm]\n"), HasSubstr("100,-1,1,100.006\n"),
                    HasSubstr("is a text between the headings and the rows")));
}

TEST(SentencesBelowHeadings, StateWhatATitleStates) {
  EXPECT_THAT(read("X [mm];Abweichung\nAlle Abweichungen in µm angegeben\n0;0\n50;2\n100;4\n"),
              StartsWith("X[mm],x[mm]\n0,0\n50,50.002\n"));
  EXPECT_THAT(read("X [mm];Abweichung [µm]\nHinweis zum Vorzeichen: Soll - Ist\n0;0\n50;-2\n100;-4\n"),
              StartsWith("X[mm],x[mm]\n0,0\n50,50.002\n"));
}

TEST(BackOrder, OtherOrdersAreNotReversed) {
  for (const char* text :
       {"Werte zurück in der Reihenfolge der Positionen (von 0 nach 100)", "Rückweg von 100 nach 0 gefahren"})
    EXPECT_THAT(read(std::string(text) + "\n" + kBack),
                AllOf(HasSubstr("100,-1,1,100.002\n"), Not(HasSubstr("the text"))))
        << text;
  for (const char* text : {"Werte in der Reihenfolge der Messung", "Messreihenfolge: Rücklauf zuerst"})
    EXPECT_THAT(read(std::string(text) + "\n" + kBack),
                AllOf(HasSubstr("100,-1,1,100.002\n"), HasSubstr("reverse the order of the values")))
        << text;
}

TEST(StatedIncrements, AreRefusedByHeadingAndByTitle) {
  EXPECT_TRUE(states_increments("Abweichung je Schritt", true));
  EXPECT_TRUE(states_increments("Errors per step", false));
  EXPECT_TRUE(states_increments("Fehler jeweils zum vorherigen Punkt", false));
  EXPECT_FALSE(states_increments("Schrittweite 50 mm, Fehler in µm", false));
  EXPECT_FALSE(states_increments("Fehler des inkrementellen Messsystems", false));
  // The proposal for a heading that nothing reads is to sum the values, and not to read them.
  EXPECT_THAT(
      read("Ziel X [mm];Schrittabweichung [µm]\n0;0\n50;2\n100;3\n150;1\n"),
      AllOf(StartsWith("refused: "), HasSubstr("by the sum of the values"), Not(HasSubstr("--deviation"))));
  SheetWords words;
  words.deviations = {"X=Schrittabweichung [µm]"};
  EXPECT_THAT(read("Ziel X [mm];Schrittabweichung [µm]\n0;0\n50;2\n100;3\n150;1\n", words),
              HasSubstr("note: the text \"Schrittabweichung [µm]\" states increments"));
}

TEST(StatedSign, AnInstrumentThatCountsAgainstTheAxisReversesTheSign) {
  const std::string table = "X [mm];Abweichung [µm]\n0;0\n50;-2\n100;-4\n";
  for (const char* text : {"Messuhr läuft entgegen der Achse", "Dial gauge counts against the axis",
                           "Messtaster zählt entgegengesetzt zur Verfahrrichtung"})
    EXPECT_THAT(read(std::string(text) + "\n" + table),
                AllOf(HasSubstr("50,50.002\n"), HasSubstr("the sign of the deviations is nominal - actual")))
        << text;
  for (const char* text : {"Messuhr verkehrt herum montiert", "dial indicator reversed"})
    EXPECT_THAT(read(std::string(text) + "\n" + table), AllOf(StartsWith("refused: "), HasSubstr("--sign")))
        << text;
  for (const char* text : {"Messuhr an der Achse X", "Messtaster gegen Anschlag gefahren, Achse X",
                           "Laser gegen die Achse ausgerichtet"})
    EXPECT_THAT(read(std::string(text) + "\n" + table), HasSubstr("50,49.998\n")) << text;
}

TEST(SignedPositions, AreAPositionAndADirection) {
  EXPECT_THAT(read("Position X [mm];Abweichung [µm]\n0+;0\n50+;2\n100+;4\n100-;9\n50-;7\n0 -;5\n"),
              AllOf(StartsWith("X[mm],x[mm],dirX\n0,0,1\n50,50.002,1\n100,100.004,1\n100,100.009,-1\n"),
                    HasSubstr("the position and the approach direction in one cell")));
}

}  // namespace
}  // namespace vernier::stated_order_test
