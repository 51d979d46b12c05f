// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/component_csv.h"

#include <gtest/gtest.h>

#include "tests/support/machines.h"
#include "tools/exchange/left_out.h"
#include "tools/exchange/table_text.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/numbers.h"

namespace vernier::component_csv_test {

using namespace vernier::exchange;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr double kDeg = 180 / 3.14159265358979323846;

std::string bridge() {
  std::mt19937_64 random(40);
  std::uniform_real_distribution<double> value(-0.02, 0.02);
  std::string text = support::bridge_text(5);
  Machine machine = parse_machine(text, "bridge.xml");
  for (Table& table : machine.tables)
    for (Station& station : table.stations)
      for (double& one : station.value) one = nine_decimals(value(random));
  return update_machine_text(text, machine, false);
}

/// The machine text with all tables zero.
std::string emptied(const std::string& text) {
  Machine machine = parse_machine(text, "bridge.xml");
  for (Table& table : machine.tables)
    for (Station& station : table.stations) station.value.fill(0);
  return update_machine_text(text, machine, false);
}

TEST(AxisCsv, RoundTripIsExact) {
  const std::string text = bridge();
  const Machine machine = parse_machine(text, "bridge.xml");
  std::string result = emptied(text);
  for (const Table& table : machine.tables)
    result = set_table(result, parse_machine(result, "bridge.xml"),
                       parse_axis_csv(axis_csv(machine, table), "x.csv", machine));
  const Machine back = parse_machine(result, "bridge.xml");
  ASSERT_EQ(back.tables.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t)
    for (std::size_t i = 0; i < machine.tables[t].stations.size(); ++i) {
      EXPECT_EQ(back.tables[t].stations[i].loc, machine.tables[t].stations[i].loc);
      EXPECT_EQ(back.tables[t].stations[i].value, machine.tables[t].stations[i].value);
    }
  EXPECT_EQ(back.tables[0].free, machine.tables[0].free);
}

TEST(AxisCsv, TakesIsoNamesAndUnits) {
  const Machine machine = parse_machine(bridge(), "bridge.xml");
  const Table table = parse_axis_csv("# c\nX[m],EXX[um],ECX[rad]\n0,10,0.001\n0.5,-20,0\n", "x.csv", machine);
  EXPECT_EQ(table.stations[1].loc, 500);
  EXPECT_DOUBLE_EQ(table.stations[0].value[0], 0.01);
  EXPECT_DOUBLE_EQ(table.stations[0].value[5], 0.001 * kDeg);
  for (const char* wrong : {"Q[mm],EXX[um]\n0,1\n1,2\n", "X[mm],EXY[um]\n0,1\n1,2\n",
                            "X[mm],EXX[deg]\n0,1\n1,2\n", "X[deg],EXX[um]\n0,1\n1,2\n",
                            "X[mm],EXX[um]\n1,1\n1,2\n", "X[mm],EXX[um]\n1,1\n", "X[mm],EXX[um]\n0,a\n1,2\n"})
    EXPECT_THROW(parse_axis_csv(wrong, "x.csv", machine), InputError) << wrong;
}

TEST(IsgCsv, RoundTripKeepsThePrintedDigits) {
  const std::string text = bridge();
  const Machine machine = parse_machine(text, "bridge.xml");
  const std::string file = isg_csv(machine);
  std::string result = emptied(text);
  for (const Table& table : parse_isg_csv(file, "x.csv", machine))
    result = set_table(result, parse_machine(result, "bridge.xml"), table);
  const Machine back = parse_machine(result, "bridge.xml");
  EXPECT_EQ(isg_csv(back), file);
  for (std::size_t t = 0; t < 3; ++t)
    for (std::size_t i = 0; i < machine.tables[t].stations.size(); ++i)
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(back.tables[t].stations[i].value[k], machine.tables[t].stations[i].value[k], 1e-12);
}

TEST(IsgCsv, ReadsTheMakersExample) {
  const Machine machine = parse_machine(bridge(), "bridge.xml");
  const auto tables = parse_isg_csv(
      "// The header contains the argument and component errors.\nX EXX EYX EZX EAX EBX ECX\n"
      "0.0 0.02 0.01 0.07 0.00 0.0042 0.003\n10.0\t0.00 -0.1 0.01 0.00 0.0011 0.002 // end\n#\nY EYY\n0 1\n5 "
      "2\n",
      "x.csv", machine);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].stations[1].value[1], -0.1);
  EXPECT_NEAR(tables[0].stations[0].value[4], 0.0042 * kDeg, 1e-12);  // rad in the file, deg here
  EXPECT_EQ(tables[1].stations[1].value[1], 2);
}

TEST(IsgCsv, RefusesWhatATableCannotHold) {
  const Machine machine = parse_machine(bridge(), "bridge.xml");
  const auto message = [&](const std::string& text) {
    try {
      parse_isg_csv(text, "x.csv", machine);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("C0Y A0Z\n0.1 0.2\n").find("x.csv:1: \"C0Y\""), std::string::npos);
  EXPECT_NE(message("Z X EXX\n0 0 1\n0 5 1\n").find("depends on two axes"), std::string::npos);
  EXPECT_NE(message("X EXX\n0 1\n5\n").find("x.csv:3"), std::string::npos);
  EXPECT_NE(message("X EXX\n0 1\n5 x\n").find("\"x\": not a number"), std::string::npos);
  EXPECT_NE(message("X EXY\n0 1\n5 2\n").find("EXY"), std::string::npos);
  EXPECT_NE(message("X EXX\n0 1\n5 2\n#\nX EYX\n0 1\n5 2\n").find("already has a table"), std::string::npos);
  EXPECT_NE(message("B EXB\n0 1\n5 2\n").find("no axis"), std::string::npos);
  EXPECT_NE(message("// nothing\n").find("no component errors"), std::string::npos);
  EXPECT_THROW(isg_csv(support::full_machine()), InputError);  // a cubic table
}

TEST(LeftOut, ErrorsOutsideTheTablesAreTold) {
  Machine machine = parse_machine(bridge(), "bridge.xml");
  std::vector<double> references;
  const States at = make_states(1, machine.axes.size(), references);
  for (Static& item : machine.statics) item.value = item.nominal.value_or(item.value);
  EXPECT_TRUE(beyond_tables(machine, at).empty());
  machine.axes[0].scale_factor = 1e-5;
  const auto left = beyond_tables(machine, at);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_GT(left[0].um, 1);
}

}  // namespace
}  // namespace vernier::component_csv_test
