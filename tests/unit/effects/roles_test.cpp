// SPDX-License-Identifier: GPL-3.0-or-later
// What a user says of a logged column counts for more than its unit and name do.
#include "tools/effects/roles.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tools/effects/input_class.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::roles_test {

using namespace vernier::effects;
using namespace vernier::model;
namespace {

constexpr const char* kMachine = R"(<machine name="slide"><variables>
  <static><BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
  <machineaxes><X min="0" max="600"/></machineaxes>
</variables><transforms branch="tool"><sixdof n="1" X="X"/></transforms></machine>)";

/// A survey whose columns bear names that say nothing.
class Roles : public testing::Test {
 protected:
  Machine machine() const { return parse_machine(kMachine, "machine.xml"); }
  Measurement rows() const {
    Measurement m;
    const auto column = [&](const char* name, const char* unit, double first) {
      Column values(4);
      values << first, first + 1, first + 2, first + 3;
      m.candidates.push_back({name, unit, values});
    };
    column("bath", "", 17);
    column("T_stamp", "degC", 100);
    column("level", "mm", 412);
    return m;
  }
};

TEST_F(Roles, StatedOnesAreDeclaredInTheMachineFile) {
  const std::string text = with_declared_columns(
      kMachine, machine(), rows(), {parse_column_role("bath=temperature"), parse_column_role("level=load")});
  const Machine told = parse_machine(text, "machine.xml");
  ASSERT_EQ(told.inputs.size(), 2u);
  EXPECT_EQ(class_of_input(told.inputs[0]), InputClass::kTemperature);
  EXPECT_DOUBLE_EQ(told.inputs[0].reference, 20);
  EXPECT_EQ(class_of_input(told.inputs[1]), InputClass::kLoad);
  EXPECT_DOUBLE_EQ(told.inputs[1].reference, 410);  // the mean, to two digits
  EXPECT_EQ(told.inputs[1].unit, "mm");
  // AND once more beside those that are there
  const std::string more =
      with_declared_columns(text, told, rows(), {parse_column_role("T_stamp=set-point")});
  EXPECT_EQ(class_of_input(parse_machine(more, "machine.xml").inputs.at(2)), InputClass::kSetpoint);
}

TEST(InputClass, OfANameThatMayBeASetPoint) {
  const auto class_of = [](const char* name) {
    Input input;
    input.name = name;
    input.unit = "degC";
    return class_of_input(input);
  };
  EXPECT_EQ(class_of("T_bed_sp"), InputClass::kSetpoint);
  EXPECT_EQ(class_of("T_bed_target"), InputClass::kSetpoint);
  EXPECT_EQ(class_of("T_sp"), InputClass::kTemperature) << "a spindle";
  EXPECT_EQ(class_of("T_set"), InputClass::kSetpoint);
}

TEST_F(Roles, IgnoredOnesAreAsIfTheyWereNotThere) {
  Measurement m = rows();
  const std::vector<ColumnRole> roles = {parse_column_role("T_stamp=ignore")};
  EXPECT_EQ(with_declared_columns(kMachine, machine(), m, roles), kMachine);
  leave_out(m, roles);
  ASSERT_EQ(m.candidates.size(), 2u);
  EXPECT_EQ(m.candidates[1].name, "level");
}

// With an empty cell, each fit of the search had rows of its own: chi^2 of other rows was compared, and
// residuals of rows were taken from others.
TEST_F(Roles, EachUndeclaredColumnGetsAValueInEveryRow) {
  Measurement rows = parse_measurement(
      "X[mm],x[mm],T[degC],few\n0,0,22,\n100,100,,\n200,200,23,\n300,300,24,1\n400,400,25,\n500,500,26,\n",
      "laser.csv", machine());
  append_measurement(rows, parse_measurement("X[mm],x[mm]\n0,0\n600,600\n", "tracker.csv", machine()), false);
  const std::vector<std::string> said = complete_columns(machine(), rows);
  ASSERT_EQ(rows.candidates.size(), 1u);  // `few` is not used
  EXPECT_EQ(rows.candidates[0].name, "T");
  Column expected(7);
  expected << 22, 23, 24, 25, 26, 20, 20;
  EXPECT_EQ((rows.candidates[0].value - expected).matrix().norm(), 0);
  EXPECT_EQ(rows.rows(), 7u);
  EXPECT_EQ(rows.excluded, 1u);
  ASSERT_EQ(said.size(), 3u);
  EXPECT_NE(said[0].find("1 rows of laser.csv"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("line 3"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("No column T in tracker.csv: these rows count as read at 20 degC"),
            std::string::npos)
      << said[1];
  EXPECT_NE(said[2].find("few is empty in 5 of 6 rows of laser.csv"), std::string::npos) << said[2];
  EXPECT_TRUE(complete_columns(machine(), rows).empty()) << "nothing is left to do";
}

TEST_F(Roles, AColumnThatCountsTheRowsIsNoInputAndNoFileIsAskedForIt) {
  Measurement rows = parse_measurement(
      "Nr,Lfd_Nr,column_,X[mm],x[mm],level,No_load\n1,1,1,0,0,1,1\n2,2,2,100,100,2,2\n3,3,3,200,200,3,1\n",
      "laser.csv", machine());
  append_measurement(rows, parse_measurement("X[mm],x[mm]\n0,0\n600,600\n", "tracker.csv", machine()), false);
  const std::vector<std::string> said = complete_columns(machine(), rows);
  ASSERT_EQ(rows.candidates.size(), 2u);
  EXPECT_EQ(rows.candidates[0].name, "level");
  EXPECT_EQ(rows.candidates[1].name, "No_load");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("(import table --set \"level=VALUE\")"), std::string::npos) << said[0];
}

TEST_F(Roles, FileWithoutTheDirectionsOfAnotherIsNamed) {
  Measurement rows =
      parse_measurement("X[mm],x[mm],dirX\n0,0,1\n100,100,1\n100,100,-1\n", "laser.csv", machine());
  append_measurement(rows, parse_measurement("X[mm],x[mm]\n0,0\n600,600\n", "tracker.csv", machine()), false);
  append_measurement(rows, parse_measurement("X[mm],x[mm]\n300,300\n300,300\n", "gauge.csv", machine()),
                     false);
  const std::vector<std::string> said = complete_columns(machine(), rows);
  ASSERT_EQ(said.size(), 1u) << "the gauge was read at one position, which has no direction";
  EXPECT_EQ(said[0].rfind("tracker.csv has no dirX, and another file has.", 0), 0u) << said[0];
  EXPECT_NE(said[0].find("(option --directions from-order of vernier import)"), std::string::npos) << said[0];
}

TEST_F(Roles, WhatIsNoRoleOrNoColumnIsRefusedByName) {
  const auto said = [&](const std::string& statement) -> std::string {
    try {
      with_declared_columns(kMachine, machine(), rows(), {parse_column_role(statement)});
    } catch (const text::InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(said("bath=warm").find("bath=warm: is NAME=ROLE"), std::string::npos);
  EXPECT_NE(said("bath").find("bath: is NAME=ROLE"), std::string::npos);
  EXPECT_NE(said("bathe=load").find("bathe: the measurement has no column"), std::string::npos);
  EXPECT_NE(said("bathe=ignore").find("bathe: the measurement has no column"), std::string::npos);
}

TEST_F(Roles, AMachineFileWithAnUnknownRoleIsRefusedWithItsLine) {
  std::string text = kMachine;
  text.insert(text.find("</machineaxes>") + 14, "\n<inputs><bath unit=\"\" role=\"warm\"/></inputs>");
  try {
    parse_machine(text, "machine.xml");
    FAIL() << "taken";
  } catch (const text::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("warm"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(":4"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vernier::roles_test
