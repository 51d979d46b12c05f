// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/joint_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vernier::joint_names_test {

using namespace vernier::importer;
using testing::ElementsAre;
namespace {

std::vector<MissingAxis> axes(const std::vector<std::string>& names) {
  std::vector<MissingAxis> list;
  for (const std::string& name : names) list.push_back({name, true});
  return list;
}

std::vector<FreeColumn> columns(const std::vector<std::string>& names, const std::string& unit) {
  std::vector<FreeColumn> list;
  for (const std::string& name : names)
    list.push_back({name + (unit.empty() ? "" : " [" + unit + "]"), name, unit});
  return list;
}

/// Words of the option --column; the first word states how sure the assignment is.
std::vector<std::string> words(const std::vector<MissingAxis>& missing, const std::vector<FreeColumn>& free) {
  const JointColumns found = joint_columns(missing, free);
  std::vector<std::string> list = {found.pairs.empty() ? "none" : found.sure ? "sure" : "proposed"};
  for (const auto& [axis, column] : found.pairs) list.push_back(column_word(missing[axis], free[column]));
  return list;
}

TEST(JointColumns, OfEqualNamesAreSure) {
  EXPECT_THAT(
      words(axes({"shoulder_pan_joint", "elbow_joint"}),
            columns({"force", "elbow", "Shoulder pan position"}, "rad")),
      ElementsAre("sure", "shoulder_pan_joint=Shoulder pan position [rad]", "elbow_joint=elbow [rad]"));
}

TEST(JointColumns, OfOneFamilyWithTheNumbersAndTheUnitOfTheAxesAreSure) {
  for (const char* const stem : {"A", "q", "joint_", "axis"})
    EXPECT_THAT(
        words(axes({"J1", "J2"}), columns({std::string(stem) + "2", std::string(stem) + "1"}, "deg")),
        ElementsAre("sure", "J1=" + std::string(stem) + "1 [deg]", "J2=" + std::string(stem) + "2 [deg]"));
}

TEST(JointColumns, OfTheOrderAloneAreProposed) {
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"q1", "q2"}, "")),  // no unit
              ElementsAre("proposed", "J1[deg]=q1", "J2[deg]=q2"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"actual_q_1", "actual_q_0"}, "rad")),
              ElementsAre("proposed", "J1=actual_q_0 [rad]", "J2=actual_q_1 [rad]"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"shoulder", "elbow"}, "deg")),
              ElementsAre("proposed", "J1=shoulder [deg]", "J2=elbow [deg]"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"Pose", "shoulder", "elbow"}, "")),
              ElementsAre("proposed", "J1[deg]=shoulder", "J2[deg]=elbow"))
      << "beside a count";
}

TEST(JointColumns, OfTwoFamiliesOrOfAnotherUnitAreNotProposed) {
  std::vector<FreeColumn> both = columns({"actual_1", "actual_2", "target_1", "target_2"}, "deg");
  EXPECT_THAT(words(axes({"J1", "J2"}), both), ElementsAre("none"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"T1", "T2"}, "degC")), ElementsAre("none"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"q1", "q2", "q3"}, "deg")), ElementsAre("none"));
  EXPECT_THAT(words(axes({"J1", "J2"}), columns({"q1"}, "deg")), ElementsAre("none"));
  EXPECT_THAT(words({}, columns({"q1"}, "deg")), ElementsAre("none"));
}

TEST(JointColumns, OfALinearAxisHaveALength) {
  EXPECT_THAT(words({{"J1", true}, {"J2", false}}, {{"q1 [deg]", "q1", "deg"}, {"q2 [mm]", "q2", "mm"}}),
              ElementsAre("sure", "J1=q1 [deg]", "J2=q2 [mm]"));
  EXPECT_THAT(words({{"J1", true}, {"J2", false}}, columns({"q1", "q2"}, "deg")), ElementsAre("none"));
}

TEST(JointSeries, IsANameWithConsecutiveNumbers) {
  EXPECT_EQ(joint_series({"Nr", "A1", "A2", "A3", "A4", "A5", "A6", "X", "Y"}), "A1 to A6");
  EXPECT_EQ(joint_series({"q_0", "q_1", "q_2", "q_3", "q_4", "q_5"}), "q_0 to q_5");
  EXPECT_EQ(joint_series({"T1", "T2", "T3", "T4"}), "") << "thermometers";
  EXPECT_EQ(joint_series({"P10", "P11", "P12", "P13", "P14"}), "") << "points";
}

}  // namespace
}  // namespace vernier::joint_names_test
