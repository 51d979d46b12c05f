// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/unit/part/part_data.h"
#include "tools/model/machine_reader.h"

namespace vernier::machine_test {

using namespace vernier::model;
using namespace vernier::part;
using namespace vernier::text;
namespace {

std::string message_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BHeadMachine, BuiltInMachineIsThePapers) {
  const BHeadMachine m = part_data::machine();
  EXPECT_NEAR(m.pivot_mm, 499.889, 1e-12);
  for (const char* name : kLocationErrors) EXPECT_TRUE(m.machine.find_static(name)) << name;
}

TEST(BHeadMachine, AnotherChainIsRefused) {
  const auto refused = [](const std::string& from, const std::string& to) {
    return message_of(
        [&] { b_head_machine(parse_machine(replaced(default_b_head_text(), from, to), "other.xml")); });
  };
  EXPECT_NE(refused("rY=\"B\"", "rX=\"B\"").find("nominal chain"), std::string::npos);
  EXPECT_NE(refused("rZ=\"C\"", "rZ=\"-C\"").find("nominal chain"), std::string::npos);
  EXPECT_NE(refused("Y=\"-Y\"", "Y=\"Y\"").find("nominal chain"), std::string::npos);
  EXPECT_NE(refused("Y=\"-Y\"", "Y=\"-Y\" X=\"0.01\"").find("nominal chain"), std::string::npos);
  EXPECT_NE(refused("EX0B\" ", "EX0B+0.00001\" ").find("nominal chain"), std::string::npos);
}

TEST(BHeadMachine, MissingAxisIsNamed) {
  EXPECT_NE(
      message_of([] {
        b_head_machine(parse_machine(
            R"(<machine name="m"><variables><static/><machineaxes><X rotary="false"/></machineaxes></variables>
                     <transforms><sixdof n="1" X="X"/></transforms></machine>)",
            "three.xml"));
      }).find("\"Y\""),
      std::string::npos);
}

TEST(SetErrors, ConvertsUnitsAndTakesTheStaticsOwnWithout) {
  const Machine m = part_data::machine("EA0B=3.2419e-4rad, EX0B=29.4um EC0Y=-0.5").machine;
  const auto value = [&](const char* name) { return m.statics[m.find_static(name).value()].value; };
  EXPECT_NEAR(value("EA0B"), 3.2419e-4 * 180 / M_PI, 1e-15);
  EXPECT_NEAR(value("EX0B"), 0.0294, 1e-15);
  EXPECT_EQ(value("EC0Y"), -0.5);
  EXPECT_EQ(value("EA0Z"), 0);
}

TEST(SetErrors, RefusesWhatItCannotUnderstand) {
  const auto message = [](const char* text) { return message_of([&] { part_data::machine(text); }); };
  EXPECT_NE(message("EA0X=1").find("EA0X"), std::string::npos);
  EXPECT_NE(message("EA0B").find("NAME=VALUE"), std::string::npos);
  EXPECT_NE(message("EA0B=").find("not a number"), std::string::npos);
  EXPECT_NE(message("EA0B=x").find("not a number"), std::string::npos);
  EXPECT_NE(message("EA0B=1mm").find("mm"), std::string::npos);
  EXPECT_NE(message("EA0B=1furlong").find("furlong"), std::string::npos);
  EXPECT_NE(message("L0=400").find("Hide"), std::string::npos);
}

}  // namespace
}  // namespace vernier::machine_test
