// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of runs and directions beside other columns: a count, a time or a remark at the left does not
// change the directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "tests/unit/import/table_reading.h"

namespace vernier::directions_of_runs_test {

using namespace vernier::importer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using vernier::importer_test::read;
namespace {

/// A table of a falling axis with a further column at the left.
std::string falling(const std::string& heading, const std::string (&cells)[4], const std::string& forth,
                    const std::string& back) {
  const std::string rows[4] = {"0;0,0;-3,0", "-50;1,3;-1,7", "-100;2,6;-0,4", "-150;3,9;0,9"};
  std::string text = heading + "Z Soll [mm];" + forth + ";" + back + "\n";
  for (std::size_t i = 0; i < 4; ++i) text += cells[i] + rows[i] + "\n";
  return text;
}

const std::string kNone[4] = {"", "", "", ""};

TEST(DirectionsOfRuns, DoNotDependOnAColumnAtTheLeft) {
  const std::string notes = "is read as the approach in the direction of decreasing positions";
  const std::string without = read(falling("", kNone, "hin [µm]", "zurück [µm]"));
  ASSERT_THAT(without,
              AllOf(HasSubstr("\n-50,-1,1,-49.9987\n"), HasSubstr("\n-50,1,1,-50.0017\n"), HasSubstr(notes)));
  for (const auto& [heading, cells] : {
           std::pair<std::string, std::array<std::string, 4>>{"Nr.;", {"1;", "2;", "3;", "4;"}},
           {"lfd. Nr.;", {"1;", "2;", "3;", "4;"}},
           {"Zeit [min];", {"0;", "2;", "4;", "6;"}},
           {"Temp. [°C];", {"20,0;", "20,0;", "20,1;", "20,2;"}},
           {"Pos.;", {"1;", "2;", "3;", "4;"}},
           {"Punkt;", {"P1;", "P2;", "P3;", "P4;"}},
       }) {
    const std::string list[4] = {cells[0], cells[1], cells[2], cells[3]};
    EXPECT_THAT(read(falling(heading, list, "hin [µm]", "zurück [µm]")),
                AllOf(HasSubstr("-50,-1,1,-49.9987\n"), HasSubstr("-50,1,1,-50.0017\n"), HasSubstr(notes)))
        << heading;
    EXPECT_THAT(read(falling(heading, list, "Abw. 1 ↑ [µm]", "Abw. 1 ↓ [µm]")),
                AllOf(HasSubstr("-150,1,1,-149.9961\n"), HasSubstr("-50,-1,1,-50.0017\n"),
                      HasSubstr("decrease from row to row")))
        << heading;
  }
}

TEST(DirectionsOfRuns, FollowTheColumnThatTheUserAssigns) {
  SheetWords words;
  words.columns = {"Z[mm]=Glas"};
  EXPECT_THAT(read("Nr.;Stufe [mm];Glas [mm];1 hin [µm];1 her [µm]\n1;1;0;0,0;-3,0\n2;2;-50;1,3;-1,7\n"
                   "3;3;-100;2,6;-0,4\n",
                   words),
              AllOf(HasSubstr(",-50,-1,1,-49.9987\n"), HasSubstr(",-50,1,1,-50.0017\n")));
}

TEST(DirectionsOfRuns, FollowTheRowsOfEachRun) {
  // The rows of both runs below each other: each run has its own rows.
  EXPECT_THAT(read("X Soll [mm];hin [µm];zurück [µm]\n0;1;\n50;2;\n100;3;\n100;;6\n50;;5\n0;;4\n"),
              HasSubstr("0,1,1,0.001\n50,1,1,50.002\n100,1,1,100.003\n100,-1,1,100.006\n50,-1,1,50.005\n"
                        "0,-1,1,0.004\n"));
}

TEST(DirectionsOfRuns, AReversalErrorBesideTheRunsIsComputed) {
  for (const std::string heading : {"Umkehrspanne [µm]", "Reversal error [µm]"})
    EXPECT_THAT(read("X Soll [mm];hin [µm];zurück [µm];" + heading + "\n0;1;4;3\n50;2;5;3\n100;3;6;3\n"),
                HasSubstr("X[mm],dirX,run,x[mm]\n0,1,1,0.001\n"))
        << heading;
}

}  // namespace
}  // namespace vernier::directions_of_runs_test
