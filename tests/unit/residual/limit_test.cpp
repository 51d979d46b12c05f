// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/limit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::limit_test {

using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::results;
using namespace vernier::text;
namespace {

nlohmann::ordered_json judged(const std::string& rows, const std::string& words) {
  const Machine machine = parse_machine(
      "<machine name=\"x\"><variables><machineaxes><X min=\"0\" max=\"300\"/></machineaxes></variables>"
      "<transforms><sixdof n=\"1\" X=\"X\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" "
      "rZ=\"0\"/></transforms></machine>",
      "x.xml");
  const Measurement m = parse_measurement(rows, "m.csv", machine);
  return judge_residuals(m, residuals(machine, m), residual_limit(words));
}

// Distances in space of 3, 5 (3 along x, 4 along y) and, in the check row, 2 um.
const std::string kRows =
    "X[mm],x[mm],y[mm],u[um],role\n0,0.003,0,2,fit\n10,10.003,0.004,2,fit\n20,20.002,0,2,check\n";
const std::string kFitRows = kRows.substr(0, kRows.find("20,20"));

TEST(ResidualLimit, CheckRowsAreJudgedWhereThereAreAny) {
  const auto answer = judged(kRows, "2u");
  EXPECT_EQ(answer["role"], "check");
  EXPECT_EQ(answer["rows"], 1);
  EXPECT_TRUE(answer["pass"]);
  EXPECT_NEAR(answer["worst"]["value"], 2, 1e-9);
}

TEST(ResidualLimit, DistanceInSpaceOfARowCounts) {
  const auto answer = judged(kFitRows, "2u");
  EXPECT_FALSE(answer["pass"]);
  EXPECT_EQ(answer["beyond"], 1);
  EXPECT_EQ(answer["worst"]["line"], 3);
  EXPECT_NEAR(answer["worst"]["value"], 5, 1e-9);
  EXPECT_NEAR(answer["worst"]["limit"], 4, 1e-9);
  EXPECT_TRUE(judged(kFitRows, "5.001um")["pass"]);
  EXPECT_FALSE(judged(kFitRows, "0.0049mm")["pass"]);
}

TEST(ResidualLimit, RmsIsJudgedWhereAsked) {
  // rms of 3 and 5 um is sqrt(17) = 4.123 um, 2.06 times u
  EXPECT_TRUE(judged(kFitRows, "rms=2.07u")["pass"]);
  EXPECT_FALSE(judged(kFitRows, "rms=2.06u")["pass"]);
  EXPECT_NEAR(judged(kFitRows, "rms=1mm")["rms"], std::sqrt(17.0), 1e-9);
}

TEST(ResidualLimit, WordsAndRowsThatGiveNoLimitAreRefused) {
  for (const char* words : {"", "u", "2", "2 u", "-2u", "2kg", "max=2u", "0u"})
    EXPECT_THROW(residual_limit(words), InputError) << words;
  EXPECT_THROW(judged("X[mm],x[mm]\n0,0.001\n", "2u"), InputError);
  EXPECT_THROW(judged(kRows, "0.1deg"), InputError);
}

}  // namespace
}  // namespace vernier::limit_test
