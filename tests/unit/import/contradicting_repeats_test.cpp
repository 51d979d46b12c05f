// SPDX-License-Identifier: GPL-3.0-or-later
// Readings at one position that cannot both be right.
#include "tools/import/sizes/contradicting_repeats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/unit/import/table_reading.h"

namespace vernier::contradicting_repeats_test {

using namespace vernier::importer;
using testing::HasSubstr;
using testing::Not;
using vernier::importer_test::read;
namespace {

const std::string kTable =
    "X Soll [mm];Abweichung X [µm]\n0;0,4\n60;2,1\n120;-1,3\n180;3,8\n240;5,2\n300;4,1\n360;6,9\n420;8,3\n";

TEST(ContradictingRepeats, AreNamedWithBothLines) {
  EXPECT_THAT(
      read(kTable + "240;5,2\n240;-51,7\n"),
      HasSubstr("note: line 11, \"-51,7\": line 6 has the same position and \"5,2\", and the difference "
                "is far larger"));
  EXPECT_THAT(read(kTable + "180;-48,0\n"),
              HasSubstr("note: line 10, \"-48,0\": line 5 has the same position and \"3,8\""));
  EXPECT_THAT(read("X Soll [mm];Ist X [mm]\n0;0,0004\n60;60,0021\n120;119,9987\n180;180,0038\n240;240,0052\n"
                   "300;300,0041\n180;179,957\n"),
              HasSubstr("note: line 8, \"179,957\": "));  // of this rule, or of an outlier of the column
}

TEST(ContradictingRepeats, PlayAndNoiseAreNone) {
  std::string text = kTable;  // without a direction, back with 20 um of play
  for (const char* row : {"420;-11,7\n", "360;-13,1\n", "300;-15,9\n", "240;-14,8\n", "180;-16,2\n",
                          "120;-21,3\n", "60;-17,9\n", "0;-19,6\n"})
    text += row;
  EXPECT_THAT(read(text), Not(HasSubstr("same position")));
  std::mt19937 random(41);  // any seed
  for (int survey = 0; survey < 300; ++survey) {
    std::student_t_distribution<double> noise(6);  // heavy tails
    std::vector<double> values;
    std::vector<std::size_t> group;
    for (std::size_t run = 0; run < 3; ++run)
      for (std::size_t target = 0; target < 10; ++target) {
        values.push_back(static_cast<double>(target) + noise(random));
        group.push_back(target);
      }
    EXPECT_THAT(contradicting_repeats(values, group), testing::IsEmpty()) << survey;
    values[7] += 60;
    EXPECT_EQ(contradicting_repeats(values, group).size(), 1) << survey;
    EXPECT_EQ(contradicting_repeats(values, group).front().far, 7) << survey;
  }
}

TEST(ContradictingRepeats, OneRunThatIsAnotherOneThroughoutIsNone) {
  std::vector<double> values;
  std::vector<std::size_t> group;
  for (std::size_t run = 0; run < 3; ++run)
    for (std::size_t target = 0; target < 8; ++target) {
      values.push_back(static_cast<double>(target % 3) + (run == 2 ? 200 : 0));
      group.push_back(target);
    }
  EXPECT_THAT(contradicting_repeats(values, group), testing::IsEmpty());
}

}  // namespace
}  // namespace vernier::contradicting_repeats_test
