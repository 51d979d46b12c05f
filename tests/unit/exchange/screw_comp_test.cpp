// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/screw_comp.h"

#include <gtest/gtest.h>

#include "tools/exchange/left_out.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

namespace vernier::screw_comp_test {

using namespace vernier::exchange;
using namespace vernier::kinematics;
using namespace vernier::model;
using namespace vernier::text;
namespace {

/// X with a table and a reversal; Y is a table under the workpiece.
std::string machine_text(const std::string& x_extra = "", const std::string& reversal = "0") {
  return R"XML(<?xml version="1.0"?>
<!-- a user's own words -->
<machine name="mill"><variables>
  <static><revX value=")XML" +
         reversal + R"XML(" nominal="0" unit="mm"/><k value="0" nominal="0"/></static>
  <machineaxes><X min="0" max="400"/><Y min="-100" max="100"/><Z min="-50" max="0"/></machineaxes>
  <inputs><T unit="degC" reference="20"/></inputs>
  <comptables>
    <table axis="X" fit="X">
      <station loc="0" X="0.012"/><station loc="150" X="-0.0345"/><station loc="400" X="0.001"/>
    </table>
    <table axis="Y"><station loc="-100" Y="0.02"/><station loc="100" Y="-0.01"/></table>
  </comptables></variables>
  <transforms branch="workpiece"><sixdof n="1" Y="Y+lYy"/></transforms>
  <transforms branch="tool"><sixdof n="1" X="X+lXx+revX*dirX)XML" +
         x_extra + R"XML("/><sixdof n="2" Z="Z"/></transforms></machine>)XML";
}

const States& at() {
  static const States kAt = make_states(1, 3, {20});
  return kAt;
}

std::vector<ScrewPoint> points_of(const Machine& machine, std::size_t axis, const States& states,
                                  double tolerance_um) {
  return screw_table(machine, axis, states, tolerance_um).points;
}

TEST(ScrewComp, TypesHaveOppositeSigns) {
  const Machine machine = parse_machine(machine_text("", "0.002"), "m.xml");
  const std::vector<ScrewPoint> points = points_of(machine, 0, at(), 0.01);
  ASSERT_EQ(points.size(), 3u);
  // The slide stands at 150 - 0.0345 + 0.002 when it comes from below: 0.0325 has to be added.
  EXPECT_NEAR(points[1].forward_trim, 0.0325, 1e-8);
  EXPECT_NEAR(points[1].reverse_trim, 0.0365, 1e-8);
  EXPECT_EQ(screw_text(points, ScrewType::kTrim),
            "0.000000 -0.014000 -0.010000\n150.000000 0.032500 0.036500\n400.000000 -0.003000 0.001000\n");
  EXPECT_EQ(
      screw_text(points, ScrewType::kActual),
      "0.000000 0.014000 0.010000\n150.000000 149.967500 149.963500\n400.000000 400.003000 399.999000\n");
  // What the controller does with a file of type 0: trim = nominal - actual.
  const auto back = parse_screw(screw_text(points, ScrewType::kActual), "x.comp", ScrewType::kActual);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back[i].forward_trim, points[i].forward_trim, 1e-9);
}

TEST(ScrewComp, SlideUnderTheWorkpieceGetsItsOwnSign) {
  const Machine machine = parse_machine(machine_text(), "m.xml");
  const std::vector<ScrewPoint> points = points_of(machine, 1, at(), 0.01);
  EXPECT_NEAR(points[0].forward_trim, -0.02, 1e-8);  // the slide is 0.02 too far, wherever it sits
  EXPECT_NEAR(points[1].forward_trim, 0.01, 1e-8);
}

TEST(ScrewComp, RoundTripGivesTheSameTable) {
  for (const ScrewType type : {ScrewType::kActual, ScrewType::kTrim})
    for (const char* reversal : {"0", "0.002"}) {
      const Machine machine = parse_machine(machine_text("", reversal), "m.xml");
      const std::string file = screw_text(points_of(machine, 0, at(), 0.01), type);
      // An empty machine of the same chain takes it over.
      std::string empty = machine_text();
      for (const char* value : {"0.012", "-0.0345", "0.001"}) {
        const auto found = empty.find(value);
        empty.replace(found, std::string(value).size(), "0");
      }
      const Machine before = parse_machine(empty, "m.xml");
      const std::string text =
          screw_into_machine(empty, before, 0, parse_screw(file, "x.comp", type), "revX");
      const Machine after = parse_machine(text, "m.xml");
      ASSERT_EQ(after.tables[0].stations.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(after.tables[0].stations[i].value, machine.tables[0].stations[i].value);
      EXPECT_EQ(after.statics[0].value, machine.statics[0].value);
      EXPECT_TRUE(after.tables[0].free[0]);
      EXPECT_NE(text.find("a user's own words"), std::string::npos);
      EXPECT_EQ(screw_text(points_of(after, 0, at(), 0.01), type), file);
    }
}

TEST(ScrewComp, CyclicErrorIsSampledAsFinelyAsItNeeds) {
  const Machine machine = parse_machine(machine_text("+0.004*sin(360*X/100)"), "m.xml");
  const auto coarse = points_of(nominal_machine(machine), 0, at(), 0.2);
  EXPECT_EQ(coarse.size(), 3u);  // the nominal chain holds the same term: no error of it
  const Machine cyclic = [] {
    Machine m = parse_machine(machine_text("+k*sin(360*X/100)"), "m.xml");
    m.statics[1].value = 0.004;
    return m;
  }();
  const auto points = points_of(cyclic, 0, at(), 0.2);
  EXPECT_GT(points.size(), 40u);
  EXPECT_LE(points.size(), kMostScrewPoints);
  // Between its lines the file is within its tolerance.
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double x = points[i].nominal + 0.37 * (points[i + 1].nominal - points[i].nominal);
    States there = at();
    there.axis[0][0] = x;
    there.direction[0][0] = 1;
    const double line = 0.63 * points[i].forward_trim + 0.37 * points[i + 1].forward_trim;
    EXPECT_NEAR(first_order_offset(cyclic, there)[0][0], line, 0.201e-3);
  }
  try {
    points_of(cyclic, 0, at(), 1e-4);
    ADD_FAILURE() << "accepted";
  } catch (const LimitNotMet& error) {
    EXPECT_NE(std::string(error.what()).find("use --tolerance 0.2"), std::string::npos) << error.what();
  }
}

/// Largest distance between the file of X and its trims at 3001 places of a range that the export does not
/// look at, um.
double worst_of_file(const Machine& machine, const std::vector<ScrewPoint>& points, double low = 0,
                     double high = 400) {
  double worst = 0;
  for (int n = 0; n <= 3000; ++n) {
    States there = at();
    there.axis[0][0] = low + (high - low) * n / 3000;
    there.direction[0][0] = 1;
    std::size_t i = 0;
    while (i + 2 < points.size() && points[i + 1].nominal < there.axis[0][0]) ++i;
    const double f = (there.axis[0][0] - points[i].nominal) / (points[i + 1].nominal - points[i].nominal);
    const double line = (1 - f) * points[i].forward_trim + f * points[i + 1].forward_trim;
    worst = std::max(worst, 1000 * std::abs(first_order_offset(machine, there)[0][0] - line));
  }
  return worst;
}

TEST(ScrewComp, WaveWhosePeriodDividesEveryQuarterIsSeen) {
  // GIVEN a screw of 5 mm pitch whose wave is 0 at every multiple of 5 mm: at all quarters of 0..400
  Machine cyclic = parse_machine(machine_text("+k*sin(360*X/5)"), "m.xml");
  cyclic.statics[1].value = 0.00584;
  // THEN 256 lines do not hold it, and the error that they leave is said
  try {
    screw_table(cyclic, 0, at(), 0.1);
    ADD_FAILURE() << "accepted";
  } catch (const LimitNotMet& error) {
    EXPECT_NE(std::string(error.what()).find("256 lines"), std::string::npos) << error.what();
  }
  // AND a period that they do hold is held, as far as the table says
  Machine slow = parse_machine(machine_text("+k*sin(360*X/50)"), "m.xml");
  slow.statics[1].value = 0.00584;
  const ScrewTable table = screw_table(slow, 0, at(), 0.1);
  EXPECT_LE(table.worst_um, 0.1);
  EXPECT_LE(worst_of_file(slow, table.points),
            table.worst_um + 0.001);  // and what probes 1/32 period apart miss
  EXPECT_GE(table.probed, 4096u);
}

TEST(ScrewComp, ABumpNarrowerThanTheLooksAndAStepAreSeen) {
  // GIVEN bumps of 0.1 mm and of 0.02 mm width, and a step, in an axis of 400 mm
  for (const char* term : {"+k*exp(0-((X-51.283)/0.0822)^2)", "+k*exp(0-((X-171.719)/0.02)^2)"}) {
    Machine bump = parse_machine(machine_text(term), "m.xml");
    bump.statics[1].value = 0.0135;
    // THEN the file has lines on the bump, and holds it as far as it says
    const ScrewTable table = screw_table(bump, 0, at(), 0.5);
    const double top = term[13] == '5' ? 51.283 : 171.719;
    const double highest = worst_of_file(bump, table.points, top - 0.2, top + 0.2);
    EXPECT_LE(highest, 0.5 + 0.05) << term;  // 0.05: between looks
  }
  Machine step = parse_machine(machine_text("+k*(X>51.283)"), "m.xml");
  step.statics[1].value = 0.01;
  const ScrewTable table = screw_table(step, 0, at(), 0.5);
  double nearest = 400;
  for (const ScrewPoint& point : table.points) nearest = std::min(nearest, std::abs(point.nominal - 51.283));
  EXPECT_LT(nearest, 0.01);  // the line that the controller draws is off beside the step by less than that
}

TEST(ScrewComp, WhatItCannotExpressIsNamed) {
  const auto reasons = [](const std::string& term) {
    Machine m = parse_machine(machine_text(term), "m.xml");
    m.statics[1].value = 1e-4;
    std::string all;
    for (const LeftOut& one : beyond_own_axis(m, 0, at())) all += one.what + "\n";
    return all;
  };
  EXPECT_EQ(reasons(""), "");
  EXPECT_EQ(reasons("+k*X"), "");
  EXPECT_EQ(reasons("+k*dirX"), "");
  EXPECT_NE(reasons("+k*Y").find("position of Y"), std::string::npos);
  EXPECT_NE(reasons("+k*dirZ*10").find("direction of motion of Z"), std::string::npos);
  EXPECT_NE(reasons("+k*X*(T-20)").find("input T"), std::string::npos);
  EXPECT_NE(reasons("+k*vX").find("speed"), std::string::npos);
  EXPECT_NE(reasons("+50*k*dirX*exp(-sinceX/1)").find("since the last reversal"), std::string::npos);
  EXPECT_NE(reasons("+k*t").find("time"), std::string::npos);
  const Machine m = parse_machine(machine_text(), "m.xml");
  EXPECT_THROW(refuse(m, "x", {{"y", 1}}, false), InputError);
  EXPECT_NO_THROW(refuse(m, "x", {{"y", 1}}, true));
}

TEST(ScrewComp, BadFilesAreRefusedWithTheirLine) {
  const auto message = [](const std::string& text) {
    try {
      parse_screw(text, "x.comp", ScrewType::kTrim);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("0 0 0\n10 0.1 0.2\n"), "");
  EXPECT_NE(message("0 0 0\n# note\n").find("x.comp:2: \"#\""), std::string::npos);
  EXPECT_NE(message("0 0 0\n10 0.1\n").find("x.comp:2"), std::string::npos);
  EXPECT_NE(message("0 0 0\n0 0.1 0\n").find("increase"), std::string::npos);
  EXPECT_NE(message("0 0 0\n").find("two lines"), std::string::npos);
  std::string many;
  for (int i = 0; i < 257; ++i) many += std::to_string(i) + " 0 0\n";
  EXPECT_NE(message(many).find("256"), std::string::npos);
}

TEST(ScrewComp, ImportRefusesWhatTheMachineWouldNotReproduce) {
  const std::string text = machine_text();
  const Machine machine = parse_machine(text, "m.xml");
  const std::vector<ScrewPoint> reversing = {{0, 0.001, 0.003}, {400, 0.002, 0.004}};
  EXPECT_THROW(screw_into_machine(text, machine, 0, reversing, ""), InputError);  // no term for it
  EXPECT_NO_THROW(screw_into_machine(text, machine, 0, reversing, "revX"));
  EXPECT_THROW(screw_into_machine(text, machine, 0, reversing, "k"), InputError);  // a static with no effect
  EXPECT_THROW(screw_into_machine(text, machine, 0, {{0, 0.001, 0.003}, {400, 0.002, 0.009}}, "revX"),
               InputError);
  EXPECT_THROW(screw_into_machine(text, machine, 2, {{-50, 0.001, 0.001}, {0, 0.002, 0.002}}, ""),
               InputError);
  const std::string scaled = machine_text("+0.0001*X");
  Machine with_k = parse_machine(machine_text("+k*X"), "m.xml");
  with_k.statics[1].value = 1e-4;
  EXPECT_THROW(screw_into_machine(update_machine_text(machine_text("+k*X"), with_k, false), with_k, 0,
                                  {{0, 0.001, 0.001}, {400, 0.002, 0.002}}, ""),
               InputError);
}

}  // namespace
}  // namespace vernier::screw_comp_test
