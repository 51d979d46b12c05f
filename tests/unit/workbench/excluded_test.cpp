// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/excluded.h"

#include "tests/unit/workbench/rig.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"
#include "tools/workbench/files/values.h"

namespace vernier::excluded_test {

using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::workbench;
namespace {

TEST(ExcludedRows, StayInTheirPlaceAndComeBackByteForByte) {
  const std::string text = test::kSmallRows;
  const std::string less = exclude_rows(text, "m.csv", {3, 5}, "table was pushed");
  const Machine machine = parse_machine(test::kSmallMachine, "m.xml");
  const Measurement m = parse_measurement(less, "m.csv", machine);
  EXPECT_EQ(m.line, (std::vector<std::size_t>{2, 6}));  // the others keep their lines
  const auto rows = excluded_rows(less);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].line, 3u);
  EXPECT_EQ(rows[0].reason, "table was pushed");
  EXPECT_EQ(rows[0].row, "50,50,50.0112,a");
  EXPECT_EQ(restore_rows(less, "m.csv", {3, 5}), text);
}

TEST(ExcludedRows, CarriageReturnsAndAMissingLastLineEndComeBackToo) {
  const std::string text = "X[mm],Y[mm],x[mm]\r\n1,2,3\r\n4,5,6";
  const std::string less = exclude_rows(text, "m.csv", {2, 3}, "x");
  EXPECT_EQ(excluded_rows(less)[0].row, "1,2,3");
  EXPECT_EQ(restore_rows(less, "m.csv", {2, 3}), text);
}

TEST(ExcludedRows, OnlyRowsCanBeTakenOutAndOnlyExcludedOnesPutBack) {
  for (const std::size_t line : {1u, 4u, 7u, 99u})  // header, remark, beyond the end
    EXPECT_THROW(exclude_rows(test::kSmallRows, "m.csv", {line}, "x"), InputError) << line;
  for (const std::size_t line : {2u, 4u, 99u})
    EXPECT_THROW(restore_rows(test::kSmallRows, "m.csv", {line}), InputError) << line;
  EXPECT_THROW(exclude_rows(test::kSmallRows, "m.csv", {2}, "a \"quote\""), InputError);
  EXPECT_THROW(exclude_rows(test::kSmallRows, "m.csv", {2}, "two\nlines"), InputError);
}

TEST(ExcludedRows, LinesAreReadAsWritten) {
  EXPECT_EQ(parse_lines("12,15-17,3"), (std::vector<std::size_t>{3, 12, 15, 16, 17}));
  for (const char* bad : {"", "0", "a", "3-", "-3", "5-3", "1,,2", "1-2-3", "99999999999"})
    EXPECT_THROW(parse_lines(bad), InputError) << bad;
}

TEST(SetValues, ReachesStaticsStationsAndBaseShifts) {
  Machine machine = parse_machine(
      "<machine name=\"m\"><variables><static><k value=\"0\"/><h value=\"1\" Hide=\"true\"/><BaseShift "
      "X=\"0\"/>"
      "<BaseShift run=\"s2\" X=\"0\"/></static><machineaxes><X/></machineaxes><comptables><table axis=\"X\" "
      "fit=\"Y\">"
      "<station loc=\"0\"/><station loc=\"100\"/></table></comptables></variables>"
      "<transforms><sixdof n=\"1\" X=\"X+k+h\" Y=\"lXy\"/></transforms></machine>",
      "m.xml");
  set_values(machine,
             {{"k", 2}, {"h", 3}, {"table.X[100].Y", 4}, {"BaseShift[s2].X", 5}, {"BaseShift.rZ", 6}});
  EXPECT_EQ(machine.statics[0].value, 2);
  EXPECT_EQ(machine.statics[1].value, 3);
  EXPECT_EQ(machine.tables[0].stations[1].value[1], 4);
  EXPECT_EQ(machine.base_shifts[1].value[0], 5);
  EXPECT_EQ(machine.base_shifts[0].value[5], 6);
  EXPECT_THROW(set_values(machine, {{"no_such", 1}}), InputError);
}

}  // namespace
}  // namespace vernier::excluded_test
