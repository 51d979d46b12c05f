// SPDX-License-Identifier: GPL-3.0-or-later
// Tables whose columns are not what they seem to be: signs in words, increments, lengths of motion,
// diameters; and the options that a refusal proposes.
#include "tools/import/reading/other_quantities.h"

#include <gmock/gmock.h>

#include <string>
#include <utility>

#include "tests/unit/import/table_reading.h"

namespace vernier::other_quantities_test {

using namespace vernier::importer;
using importer_test::read;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(SignColumn, WordsWithTheSignOfTheDeviationAreRead) {
  const auto table = [](const std::string& heading, const std::string& plus, const std::string& minus) {
    return "Soll X [mm];Abweichung X [um];" + heading + "\n0;3,8;" + minus + "\n50;0,5;" + plus + "\n100;2;" +
           plus + "\n";
  };
  for (const std::string& text : {table("Lage", "zu groß", "zu klein"), table("Hinweis", "plus", "minus"),
                                  table("Remark", "over", "under"), table("Vorzeichen", "zu weit", "zu kurz"),
                                  table("Bemerkung", "zu lang", "zu kurz")})
    EXPECT_THAT(read(text),
                AllOf(HasSubstr("\n0,-0.0038"), HasSubstr("\n50,50.0005"), HasSubstr("\n100,100.002"),
                      HasSubstr("has the signs of \"Abweichung X [um]\": the values get them")))
        << text;
}

TEST(SignColumn, WordsThatAreNotClearAreRefusedOrLeft) {
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um];Vorzeichen\n0;3,8;links\n50;0,5;rechts\n100;2;links\n"),
              AllOf(StartsWith("refused"), HasSubstr("no known sign"), HasSubstr("--leave \"Vorzeichen\"")));
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um];Lage\n-50;3,8;zu kurz\n50;0,5;zu weit\n100;2;zu kurz\n"),
              AllOf(StartsWith("refused"), HasSubstr("positions below zero")));
  // Signed values have their signs, a remark in one row is about this row, and words of a way are no signs.
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um];Lage\n0;-3,8;zu klein\n50;0,5;zu groß\n100;2;zu groß\n"),
              AllOf(HasSubstr("\n0,-0.0038"), Not(HasSubstr("get them"))));
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um];Bemerkung\n0;3,8;\n50;0,5;zu klein\n100;2;\n150;3;\n"),
              AllOf(HasSubstr("\n50,50.0005"), Not(HasSubstr("get them"))));
}

TEST(SignColumn, TwoColumnsOfSizesAreOneColumn) {
  EXPECT_THAT(read("Soll X [mm];zu kurz [um];zu lang [um]\n0;4,0;\n50;;2,5\n100;1;\n"),
              AllOf(HasSubstr("\n0,-0.004"), HasSubstr("\n50,50.0025"), HasSubstr("\n100,99.999"),
                    HasSubstr("are read as one column of deviations")));
  EXPECT_THAT(read("Soll X [mm];zu kurz [um];zu lang [um]\n0;4,0;1\n50;;2,5\n100;1;\n"),
              StartsWith("refused"));
}

TEST(OtherQuantities, IncrementsAreNoDeviations) {
  const std::string rows = "0;1,0\n50;2,0\n100;-1,0\n";
  for (const std::string head :
       {"X [mm];Incremental error X [um]\n", "X [mm];Differenz zur Vorposition X [um]\n",
        "X [mm];Pitch error X [um] (per pitch)\n", "Schrittfehler der Achse\nX [mm];Abweichung X [um]\n",
        "Abweichung gegenüber der vorigen Position\nX [mm];Abweichung X [um]\n",
        "Interval error (increment to previous target)\nX [mm];Error X [um]\n"})
    EXPECT_THAT(read(head + rows), AllOf(StartsWith("refused"), HasSubstr("are increments"))) << head;
  SheetWords words;
  words.deviations = {"X[um]=Incremental error X [um]"};
  EXPECT_THAT(read("X [mm];Incremental error X [um]\n" + rows, words), HasSubstr("\n50,50.002"));
  // The step of the positions and another measurement are no increments of the deviation.
  EXPECT_THAT(read("Increment 50 mm\nX [mm];Error X [um]\n" + rows), HasSubstr("\n50,50.002"));
  EXPECT_THAT(read("Vergleich mit der vorigen Messung\nX [mm];Abweichung X [um]\n" + rows),
              HasSubstr("\n50,50.002"));
}

TEST(OtherQuantities, ALengthOfMotionThatNeverChangesIsNoPosition) {
  const std::string table = "Weg X [mm];Abweichung X [um]\n50;1,0\n50;2,0\n50;-1,0\n";
  EXPECT_THAT(read(table), AllOf(StartsWith("refused"), HasSubstr("the length of each motion")));
  SheetWords words;
  words.columns = {"X[mm]=Weg X [mm]"};
  EXPECT_THAT(read(table, words), HasSubstr("\n50,50.001"));
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um]\n50;1,0\n50;2,0\n50;-1,0\n"), HasSubstr("\n50,50.001"));
}

TEST(OtherQuantities, DiametersAreNoted) {
  EXPECT_THAT(read("X Durchmesser Soll [mm];X Durchmesser Ist [mm]\n0;0,001\n50;50,002\n100;100,003\n"),
              AllOf(HasSubstr("\n50,50.002"), HasSubstr("has diameters")));
}

TEST(Proposals, AreADeviationAndNotARunOrATarget) {
  const std::string polish = "Pozycja X [mm];Kierunek;Przebieg;Odchyłka X [µm]\n";
  std::string rows, dutch = "Doelpositie X [mm];Run;Afwijking X [µm]\n";
  for (const char* const run : {"1", "2"})
    for (const char* const row : {"0;", "100;", "200;"}) {
      rows += std::string(row) + "+;" + run + ";" + "3,5\n";
      dutch += std::string(row) + run + ";" + "3,5\n";
    }
  EXPECT_THAT(read(polish + rows),
              AllOf(HasSubstr("--deviation \"X=Odchyłka X [µm]\""), Not(HasSubstr("=Przebieg"))));
  EXPECT_THAT(read(dutch), HasSubstr("--column \"X=Doelpositie X [mm]\" --deviation \"X=Afwijking X [µm]\""));
  EXPECT_THAT(read("Pos.;Soll;Ist;Diff.\n1;0,000;0,0002;0,0002\n2;50,000;50,0037;0,0037\n"
                   "3;100,000;100,0053;0,0053\n4;150,000;150,0074;0,0074\n"),
              AllOf(HasSubstr("--column \"x[mm]=Ist\""), Not(HasSubstr("--deviation"))));
  EXPECT_THAT(
      read("Soll X [mm];Einzelabweichung X [um];Summenabweichung X [um]\n0;1;1\n50;2;3\n100;3;6\n150;1;7\n"),
      HasSubstr("--deviation \"X=Summenabweichung X [um]\""));
}

TEST(Proposals, HeadingsInAnotherEncodingAreNoted) {
  const std::string rows = ";B\n0;1,5\n100;2,5\n200;1,0\n";
  // "Цель" in Windows-1251, and "Länge" in Windows-1252.
  for (const auto& [heading, noted] :
       {std::pair("\xD6\xE5\xEB\xFC X [mm]", true), std::pair("L\xE4nge X [mm]", false)}) {
    const SheetReading reading = read_as_sheet(heading + rows, "s.csv", {});
    bool found = false;
    for (const std::string& note : reading.sheet.notes)
      found |= note.find("Windows-1252") != std::string::npos;
    EXPECT_EQ(found, noted) << heading;
  }
}

TEST(Proposals, DistancesBetweenPointsAreNamed) {
  EXPECT_THAT(read("Ecke;X [mm];Y [mm];Z [mm];Abstand [mm];von\nA;40;40;0,2;;\nB;260;40;0,2;220,39;A\n"),
              HasSubstr("--column \"distance=Abstand [mm]\" --column \"from=von\""));
}

TEST(Proposals, NameACellThatIsNoNumber) {
  EXPECT_THAT(read("Position;Dev X [um]\nX=0;0.2\nX=50;3.7\n"),
              AllOf(StartsWith("refused"), HasSubstr("\"X=0\""), Not(HasSubstr("--set"))));
  EXPECT_THAT(read("Target X [mm],Error X [um]\n0,1.0\n1 31/32,2.0\n3 15/16,1.0\n"),
              AllOf(StartsWith("refused"), HasSubstr("\"1 31/32\""), Not(HasSubstr("--set"))));
  EXPECT_THAT(read("Target X (ft),Error X (in)\n0.0,0.0001\n0.5,0.0002\n"),
              HasSubstr("[ft] is no known unit"));
  EXPECT_THAT(read("Lauf;0 mm;50 mm;100 mm\n1;0,2;3,7;5,3\n2;0,1;3,5;5,2\n"),
              HasSubstr("the headings of the columns are positions"));
  EXPECT_THAT(read("Soll X [mm];Abweichung X [um]\n0;-\u00a04,0\n50;- 0,5\n100;1,0\n"),
              AllOf(HasSubstr("\n0,-0.004"), HasSubstr("\n50,49.9995")));
}

}  // namespace vernier::other_quantities_test
