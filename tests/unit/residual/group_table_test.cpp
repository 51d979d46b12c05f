// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/group_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::group_table_test {

using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::results;
using namespace vernier::text;
namespace {

const char* const kMachine =
    "<machine name=\"x\"><variables><machineaxes><X min=\"0\" max=\"300\"/></machineaxes></variables>"
    "<transforms><sixdof n=\"1\" X=\"X\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></transforms></machine>";

nlohmann::ordered_json by(const std::string& rows, const std::string& column) {
  const Machine machine = parse_machine(kMachine, "x.xml");
  const Measurement m = parse_measurement(rows, "m.csv", machine);
  return group_table(machine, m, residuals(machine, m), {column});
}

TEST(GroupTable, MeansAndTheirTestByHand) {
  // GIVEN residuals of 1 and 3 um by one operator, 5 and 7 by the other, and a check row that counts for
  // nothing
  const auto table =
      by("X[mm],x[mm],operator,role\n0,0.001,anna,fit\n1,1.005,bert,fit\n2,2.003,anna,fit\n3,3.007,bert,fit\n"
         "4,5,anna,check\n",
         "operator");
  const auto& each = table[0]["each"];
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[0]["value"], "anna");
  EXPECT_NEAR(each[0]["readings"][0]["mean"], 2, 1e-9);
  EXPECT_NEAR(each[1]["readings"][0]["mean"], 6, 1e-9);
  EXPECT_NEAR(each[1]["readings"][0]["rms"], std::sqrt(37.0), 1e-9);
  EXPECT_EQ(each[1]["readings"][0]["n"], 2);
  // THEN F = (16/1) / (4/2) = 8, which is t^2 of two degrees of freedom: p = 1 - sqrt(8/10).
  EXPECT_NEAR(table[0]["differ_p"], 1 - std::sqrt(0.8), 1e-9);
}

TEST(GroupTable, NumbersAndRunsGroupTooAndEmptyCellsAreAGroup) {
  const std::string rows =
      "X[mm],x[mm],n_sp[rpm],tool,run\n0,0.001,1000,T1,a\n1,1.001,2000,,a\n2,2.002,1000,T1,b\n3,3.003,2000,"
      "T7,b\n";
  EXPECT_EQ(by(rows, "n_sp")[0]["each"].size(), 2u);
  EXPECT_EQ(by(rows, "n_sp")[0]["each"][0]["value"], "1000");
  EXPECT_EQ(by(rows, "run")[0]["each"].size(), 2u);
  EXPECT_EQ(by(rows, "tool")[0]["each"][0]["value"], "(empty)");
  EXPECT_TRUE(by("X[mm],x[mm],tool\n0,0.001,T1\n1,1.001,T1\n", "tool")[0]["differ_p"].is_null());
}

TEST(GroupTable, ApproachDirectionsAndAxesGroupToo) {
  const std::string rows = "X[mm],dirX,x[mm]\n0,1,0.001\n0,-1,-0.001\n9,1,9.002\n9,-1,8.998\n";
  const auto table = by(rows, "dirX");
  const auto& each = table[0]["each"];
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[0]["value"], "-1");
  EXPECT_NEAR(each[0]["readings"][0]["mean"], -1.5, 1e-9);
  EXPECT_EQ(by(rows, "X")[0]["each"].size(), 2u);
}

TEST(GroupTable, UnknownColumnIsNamedWithThoseThatAreThere) {
  try {
    by("X[mm],x[mm],tool\n0,0.001,T1\n1,1.001,T1\n", "operator");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its columns are run, tool, X, dirX"), std::string::npos)
        << error.what();
  }
}

TEST(GroupTable, ColumnOfWordsWithANumberAmongThemIsKept) {
  const auto table = by("X[mm],x[mm],tool\n0,0.001,T1\n1,1.001,7\n2,2.001,T1\n", "tool");
  EXPECT_EQ(table[0]["each"].size(), 2u);
  EXPECT_THROW(by("X[mm],x[mm],tool\n0,0.001,1\n1,1.001,7\n2,2.001,T1\n", "tool"), InputError);
}

}  // namespace
}  // namespace vernier::group_table_test
