// SPDX-License-Identifier: GPL-3.0-or-later
// Rows at one pose whose points cannot both be right, and repeats that can.
#include "tools/fit/noise/contradicting_rows.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/model/machine_reader.h"

namespace vernier::contradicting_rows_test {
namespace {

constexpr const char* kMachine =
    R"xml(<machine><variables><machineaxes><X min="0" max="600"/><Y min="0" max="400"/></machineaxes></variables>
    <transforms><sixdof X="X" Y="Y"/></transforms></machine>)xml";

std::vector<fit::ContradictingRows> found(const std::string& csv, std::string* words = nullptr) {
  const model::Measurement m =
      model::parse_measurement(csv, "p.csv", model::parse_machine(kMachine, "m.xml"));
  const auto list = fit::contradicting_rows(m);
  if (words != nullptr) *words = fit::contradiction_in_words(m, list);
  return list;
}

/// Different poses, and below them `more` rows. `columns`: of the file; `tail`: cells behind x, y, z.
std::string survey(const std::string& more, const std::string& columns = "X[mm],Y[mm],x[mm],y[mm],z[mm]",
                   const std::string& tail = "") {
  std::string csv = columns + "\n";
  for (int i = 0; i < 10; ++i)
    csv += fmt::format("{0},{1},{0}.003,{1}.001,0{2}\n", 50 * i, (70 * i) % 300, tail);
  return csv + more;
}

TEST(ContradictingRows, APointAtTheWrongPoseIsNamedWithItsLines) {
  std::string words;
  const auto list = found(survey("100,140,103.6,140.8,0.1\n"), &words);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_NEAR(list[0].apart_um, 1e3 * std::sqrt(3.597 * 3.597 + 0.799 * 0.799 + 0.01), 0.1);
  EXPECT_NE(words.find("The rows in lines 4 and 12 of p.csv have the same commanded position, and their "
                       "points are 3686 um apart"),
            std::string::npos)
      << words;
  EXPECT_EQ(fit::contradiction_in_words({}, {}), "");
}

TEST(ContradictingRows, RepeatsWithinTheirUncertaintyAreNone) {
  EXPECT_TRUE(found(survey("100,140,100.103,140.001,0\n")).empty()) << "0.1 mm may be a drift";
  const std::string with_u = "X[mm],Y[mm],x[mm],y[mm],z[mm],u[um]";
  EXPECT_TRUE(found(survey("100,140,100.303,140.001,0,30\n", with_u, ",30")).empty()) << "7 times u";
  EXPECT_EQ(found(survey("100,140,100.303,140.001,0,5\n", with_u, ",5")).size(), 1U) << "42 times u";
}

TEST(ContradictingRows, OtherPosesRunsOfAnotherSetUpAndDirectionsAreNone) {
  EXPECT_TRUE(found(survey("100,141,103.6,140.8,0.1\n")).empty()) << "another pose";
  EXPECT_TRUE(
      found(survey("100,140,103.6,140.8,0.1,b\n", "X[mm],Y[mm],x[mm],y[mm],z[mm],setup", ",a")).empty())
      << "the instrument stood elsewhere";
  EXPECT_TRUE(
      found(survey("100,140,103.6,140.8,0.1,-1\n", "X[mm],Y[mm],x[mm],y[mm],z[mm],dirX", ",1")).empty())
      << "play";
}

/// A pose that a heating machine visits again and again: each visit differs from the first by far more than
/// u.
TEST(ContradictingRows, ADriftIsNoContradiction) {
  std::string drift, jump;
  for (int i = 0; i < 40; ++i) drift += fmt::format("600,0,{:.4f},0,0,1\n", 600 + 0.01 * i);
  const std::string columns = "X[mm],Y[mm],x[mm],y[mm],z[mm],u[um]";
  EXPECT_TRUE(found(survey(drift, columns, ",1")).empty());
  for (int i = 0; i < 40; ++i)
    jump += fmt::format("600,0,{:.4f},0,0,1\n", i == 17 ? 604 : 600 + 0.001 * (i % 3));
  ASSERT_EQ(found(survey(jump, columns, ",1")).size(), 1U);
}

}  // namespace
}  // namespace vernier::contradicting_rows_test
