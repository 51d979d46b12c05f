// SPDX-License-Identifier: GPL-3.0-or-later
// Runs whose headings state the approach direction by a letter, by a word of another language or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::run_pairs_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

const std::string kRows = "0;1;2;3;4\n50;5;6;7;8\n100;9;10;11;12\n";
const std::string kRead =
    "X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.005\n100,1,1,100.009\n100,-1,1,100.01\n50,-1,1,50.006\n"
    "0,-1,1,0.002\n0,1,2,0.003\n";

TEST(RunPairs, LettersThatMeanADirectionAsAPairAreTheTwoApproaches) {
  for (const char* headings : {"V1 [µm];R1 [µm];V2 [µm];R2 [µm]", "1H;1Z;2H;2Z", "F1;B1;F2;B2",
                               "Up1;Dn1;Up2;Dn2", "1. V;1. R;2. V;2. R"})
    EXPECT_THAT(
        read(std::string("Achse X, Abweichungen in µm, Positionen in mm\nPos;") + headings + "\n" + kRows),
        AllOf(StartsWith(kRead), HasSubstr("are read as the approach")))
        << headings;
}

TEST(RunPairs, AMinusBeforeTheStrokeOfAUnitIsADirection) {
  EXPECT_THAT(read("Achse X\nPos/mm;1+/µm;1-/µm;2+/µm;2-/µm\n" + kRows), StartsWith(kRead));
}

TEST(RunPairs, WordsOfOtherLanguagesAreDirections) {
  for (const char* table :
       {"Eje X\nPosición [mm];ida 1 [µm];vuelta 1 [µm];ida 2 [µm];vuelta 2 [µm]\n",
        "Oś X\nPozycja [mm];przód 1 [µm];tył 1 [µm];przód 2 [µm];tył 2 [µm]\n",
        "Osa X\nPoloha [mm];tam 1 [µm];zpět 1 [µm];tam 2 [µm];zpět 2 [µm]\n",
        "X-axel\nLäge [mm];fram 1 [µm];tillbaka 1 [µm];fram 2 [µm];tillbaka 2 [µm]\n",
        "Achse X\nPos [mm];1. Vorlauf [µm];1. Rücklauf [µm];2. Vorlauf [µm];2. Rücklauf [µm]\n"})
    EXPECT_THAT(read(table + kRows), StartsWith(kRead)) << table;
}

TEST(RunPairs, OtherColumnsWithNumbersStayWhatTheyAre) {
  // Two units, one number, or other numbers are no pair.
  EXPECT_THAT(read("Achse X\nSoll X [mm];Abw. X [µm];V1 [mm/s];R1 [V]\n0;1;2;3\n50;5;6;7\n"),
              AllOf(StartsWith("X[mm],x[mm],V1[mm/s],R1[V]\n"), Not(HasSubstr("are read as the approach"))));
  EXPECT_THAT(read("Achse X\nSoll X [mm];Abw. X [µm];H1;Z2\n0;1;2;3\n50;5;6;7\n"),
              Not(HasSubstr("are read as the approach")));
}

TEST(RunPairs, HeadingsInAnUnknownLanguageAreRefusedWithTheMend) {
  EXPECT_THAT(read("Tengely X\nPozíció [mm];oda 1 [µm];vissza 1 [µm];oda 2 [µm];vissza 2 [µm]\n" + kRows),
              AllOf(StartsWith("refused: "),
                    HasSubstr("if \"oda 1 [µm]\", \"vissza 1 [µm]\" and so on are runs forward and "
                              "back, write the number and the direction in their headings: 1+, 1-"),
                    Not(HasSubstr("x=Poz"))));
  EXPECT_THAT(read("Achse X\nPos [mm];1+ [µm];1- [µm];2+ [µm];2- [µm]\n" + kRows), StartsWith(kRead));
}

TEST(RunPairs, ALengthBesideNumberedColumnsIsNoPointOfARobot) {
  EXPECT_THAT(read("Achse X, Positionen in mm\nPos;A 1;A 2;A 3\n0;1;2;3\n50;5;6;7\n"),
              Not(HasSubstr("the point that was measured in the poses of a robot")));
}

TEST(OddRuns, ARunOfZerosAndACopiedLineAreNoted) {
  std::string zeros = "Achse X\nPos [mm];1+ [µm];1- [µm];2+ [µm];2- [µm]\n", copy = zeros;
  for (int k = 0; k < 5; ++k) {
    const std::string at =
        std::to_string(50 * k) + ";" + std::to_string(k + 1) + ";" + std::to_string(k - 7) + ";";
    zeros += at + "0,0;0,0\n";
    copy += at + "1;2\n" + (k == 2 ? at + "1;2\n" : "");
  }
  EXPECT_THAT(read(zeros), AllOf(StartsWith("X[mm]"), HasSubstr("all 10 deviations of run 2 are 0")));
  EXPECT_THAT(read(copy),
              AllOf(StartsWith("X[mm]"), HasSubstr("line 6: the position and all 4 readings are those of "
                                                   "line 5: is the line a copy?")));
  EXPECT_THAT(read("Achse X\nPos [mm];1+ [µm];1- [µm];2+ [µm];2- [µm]\n" + kRows),
              AllOf(Not(HasSubstr("is the line a copy")), Not(HasSubstr("was this run not measured"))));
}

}  // namespace
}  // namespace vernier::run_pairs_test
