// SPDX-License-Identifier: GPL-3.0-or-later
// Values that are no readings before the user changes them: the refusal names the change, and no option that
// would read them wrongly.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/unit/import/table_reading.h"

namespace vernier::values_beside_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using vernier::importer_test::read;
namespace {

TEST(ValuesBeside, ADialThatPassedZeroIsRefused) {
  const std::string rows = "0;2\n50;5\n100;9\n150;97\n200;94\n250;1\n300;98\n";
  EXPECT_THAT(read("Soll X [mm];Messuhr [1/100 mm]\n" + rows),
              AllOf(StartsWith("refused: "), HasSubstr("(97 becomes -3)"), Not(HasSubstr("--deviation"))));
  const std::string own = "X [mm];Abweichung Messuhr [1/100 mm]\n" + rows;
  EXPECT_THAT(read(own), AllOf(StartsWith("refused: "),
                               HasSubstr("subtract 100 from each value in the file from this row on")));
  // The user says that the values are right.
  SheetWords words;
  words.deviations = {"X[0.01mm]=Abweichung Messuhr [1/100 mm]"};
  EXPECT_THAT(read(own, words),
              AllOf(HasSubstr("150,150.97\n"), HasSubstr("nearly a whole turn of a dial gauge")));
  // Half a turn and less is no jump, and negative readings are no turns.
  EXPECT_THAT(read("X [mm];Abweichung [1/100 mm]\n0;2\n50;20\n100;45\n150;30\n200;10\n"),
              StartsWith("X[mm],x[mm]\n"));
  EXPECT_THAT(read("X [mm];Abweichung [1/100 mm]\n0;2\n50;5\n100;9\n150;-3\n200;-6\n"),
              StartsWith("X[mm],x[mm]\n"));
}

TEST(ValuesBeside, NumbersOfPositionsAreNoPositions) {
  EXPECT_THAT(read("Pos.;Lauf 1 [µm];Lauf 2 [µm]\n1;0;6\n2;2;8\n3;4;10\n4;5;12\n"),
              AllOf(StartsWith("refused: "), HasSubstr("has the numbers of the positions"),
                    Not(HasSubstr("X[mm]="))));
  EXPECT_THAT(read("Achse X\nPos.;Abweichung [µm]\n1;0\n2;2\n3;4\n4;5\n"),
              HasSubstr("the numbers of the positions"));
  EXPECT_THAT(read("Achse X\nPos. [mm];Abweichung [µm]\n1;0\n2;2\n3;4\n4;5\n"),
              StartsWith("X[mm],x[mm]\n1,1\n"));
}

TEST(ValuesBeside, LengthsOfStepsAreSummedBeforeTheyAreRead) {
  EXPECT_THAT(read("von [mm];bis [mm];gemessene Länge [mm]\n0;50;50,0021\n50;100;50,0023\n100;150;50,0015\n"
                   "150;200;50,0024\n"),
              AllOf(StartsWith("refused: "), HasSubstr("the sum of \"gemessene Länge [mm]\""),
                    Not(HasSubstr("--column"))));
  EXPECT_THAT(read("X [mm];Weg gemessen [mm]\n0;0\n50;50,0021\n100;50,0021\n150;50,0021\n200;50,0021\n"),
              AllOf(StartsWith("refused: "), HasSubstr("by their sums from the first row"),
                    Not(HasSubstr("--column"))));
}

TEST(ValuesBeside, AnInstrumentThatCountsDownIsReadAfterAChange) {
  const std::string table =
      "Verfahrweg [mm];Laseranzeige [mm]\n0;300,0000\n50;249,9979\n100;199,9956\n150;149,9941\n200;99,9917\n";
  EXPECT_THAT(read(table),
              AllOf(StartsWith("refused: "), HasSubstr("--column \"X=Verfahrweg [mm]\""),
                    HasSubstr("replace each value of \"Laseranzeige [mm]\" in the file by 300 minus")));
  SheetWords words;
  words.columns = {"X=Verfahrweg [mm]", "x=Laseranzeige [mm]"};
  EXPECT_THAT(read(table, words), HasSubstr("by 300 minus the value"));
}

TEST(ValuesBeside, MeansOfBothDirectionsAreProposedTogether) {
  EXPECT_THAT(read("X [mm];Mittel vor [µm];s vor [µm];Mittel rück [µm];s rück "
                   "[µm]\n0;0;1;6;1\n50;2;1;8;1\n100;4;1;9;1\n"),
              AllOf(StartsWith("refused: "), HasSubstr("\"Mittel vor [µm]\" and \"Mittel rück [µm]\""),
                    Not(HasSubstr("--deviation"))));
}

TEST(ValuesBeside, TheLogOfARobotIsNoTableOfDeviations) {
  SheetWords words;
  for (int joint = 1; joint <= 6; ++joint) words.axes.push_back(fmt::format("joint_a{}", joint));
  EXPECT_THAT(
      read("Nr;A1;A2;A3;A4;A5;A6;X;Y;Z\n1;-82;-96;106;19;-81;-22;32;504;983\n2;-4;-104;98;-92;-21;5;482;1;"
           "1037\n3;-13;-61;98;109;-43;50;728;239;551\n4;78;-61;66;65;-93;70;242;-772;918\n",
           words),
      AllOf(StartsWith("refused: "), HasSubstr("--column \"x[mm]=X\""), HasSubstr("is no measurement"),
            Not(HasSubstr("--deviation"))));
}

/// A table of points in the frame of a tracker. `shift`: the points belong to the targets this many rows
/// above; `mirror`: the headings of x and y are exchanged.
std::string points(int shift, bool mirror) {
  constexpr int kRows = 12;
  std::string text =
      mirror ? "X Soll [mm];Y Soll [mm];Z Soll [mm];Tracker y [mm];Tracker x [mm];Tracker z [mm]\n"
             : "X Soll [mm];Y Soll [mm];Z Soll [mm];Tracker x [mm];Tracker y [mm];Tracker z [mm]\n";
  const auto target = [](int row) {
    return std::array<double, 3>{40.0 * ((row * 7) % 11), 35.0 * ((row * 5) % 9), 25.0 * ((row * 3) % 7)};
  };
  for (int row = 0; row < kRows; ++row) {
    const auto at = target(row), of = target(row + shift);
    // Turned by 30 deg about Z, and moved.
    const double c = std::sqrt(0.75), s = 0.5;
    text += fmt::format("{};{};{};{:.4f};{:.4f};{:.4f}\n", at[0], at[1], at[2], c * of[0] - s * of[1] + 1000,
                        s * of[0] + c * of[1] - 500, of[2] + 200);
  }
  return text;
}

TEST(PointRows, ShiftedAndMirroredPointsAreRefused) {
  EXPECT_THAT(read(points(0, false)), StartsWith("X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm]\n"));
  EXPECT_THAT(read(points(1, false)), AllOf(StartsWith("refused: "), HasSubstr("of the row below them")));
  EXPECT_THAT(read(points(-1, false)), AllOf(StartsWith("refused: "), HasSubstr("of the row above them")));
  EXPECT_THAT(read(points(0, true)), AllOf(StartsWith("refused: "), HasSubstr("as a mirror image only")));
  SheetWords words;
  words.columns = {"x=Tracker x [mm]"};
  EXPECT_THAT(read(points(0, true), words), HasSubstr("note: \"Tracker x [mm]\": the points x, y, z fit"));
}

TEST(RunsSideBySide, MayHaveTheirOwnPositionsBelowOneDirectionEach) {
  for (const char* words : {"steigend;;;fallend;", "ascending;;;descending;", "hin;;;rück;"})
    EXPECT_THAT(
        read(std::string(words) + "\nX [mm];Abw [µm];;X [mm];Abw [µm]\n0;1;;100;6\n50;3;;50;4\n100;5;;0;2\n"),
        StartsWith("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n50,1,1,50.003\n100,1,1,100.005\n100,-1,1,100.006\n"))
        << words;
}

TEST(UnitsOfSlopes, AreRefusedWithBothMeanings) {
  EXPECT_THAT(
      read("X [mm];Abweichung [µm/m]\n0;0\n50;2\n100;4\n"),
      AllOf(StartsWith("refused: "), HasSubstr("multiply each of them"), HasSubstr("1 um/m is 1 urad")));
}

}  // namespace
}  // namespace vernier::values_beside_test
