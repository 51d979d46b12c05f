// SPDX-License-Identifier: GPL-3.0-or-later
// Which degree of freedom an axis moves, in every reference machine.
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/effects/candidates.h"
#include "tools/model/machine_reader.h"

namespace vernier::places_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

using diagnose_test::machine_path;

/// Read off the machine files: branch, n, degree of freedom, sense.
std::string place_text(const Machine& machine, const char* axis) {
  const std::size_t index = *machine.find_axis(axis);
  const AxisPlaces places(machine);
  const auto& own = places.own(index);
  if (!own) return "none";
  return fmt::format("{} {} {} {:+}", own->workpiece ? "workpiece" : "tool", transform_at(machine, *own).n,
                     dof_name(machine, *own), static_cast<int>(places.sense(index)));
}

TEST(OwnPlace, IsFoundForEveryAxisOfTheReferenceMachines) {
  const std::map<std::string, std::map<const char*, std::string>> expected = {
      {"column_moving_table", {{"X", "workpiece 2 X +1"}, {"Y", "workpiece 1 Y +1"}, {"Z", "tool 1 Z +1"}}},
      {"fixed_bridge", {{"X", "tool 1 X +1"}, {"Y", "workpiece 1 Y +1"}, {"Z", "tool 2 Z +1"}}},
      {"fixed_horizontal_arm", {{"X", "workpiece 1 X +1"}, {"Y", "tool 1 Y +1"}, {"Z", "tool 2 Z +1"}}},
      {"moving_horizontal_arm", {{"X", "tool 1 X +1"}, {"Z", "tool 2 Z +1"}, {"Y", "tool 3 Y +1"}}},
      {"gantry", {{"Y", "tool 1 Y +1"}, {"X", "tool 2 X +1"}, {"Z", "tool 3 Z +1"}}},
      {"l_bridge", {{"Y", "tool 1 Y +1"}, {"X", "tool 2 X +1"}, {"Z", "tool 3 Z +1"}}},
      {"moving_bridge", {{"Y", "tool 1 Y +1"}, {"X", "tool 2 X +1"}, {"Z", "tool 3 Z +1"}}},
      {"five_axis_bhead_ctable",
       {{"X", "tool 1 X +1"},
        {"Y", "workpiece 2 Y -1"},
        {"Z", "tool 2 Z +1"},
        {"B", "tool 4 rY +1"},
        {"C", "workpiece 3 rZ +1"}}},
      {"fibre_placement",
       {{"Xm", "tool 2 X +1"},
        {"Ym", "tool 3 Y +1"},
        {"Zm", "tool 4 Z +1"},
        {"Cpm", "tool 4 rZ +1"},
        {"Am", "tool 5 rZ +1"},
        {"Bm", "tool 6 rZ +1"},
        {"Cm", "tool 7 rZ +1"}}},
      {"fibre_placement_dh",
       {{"Xm", "tool 1 a +1"},
        {"Ym", "tool 2 d +1"},
        {"Zm", "tool 3 d +1"},
        {"Cpm", "tool 3 theta +1"},
        {"Am", "tool 4 theta +1"},
        {"Bm", "tool 5 theta +1"},
        {"Cm", "tool 7 theta +1"}}},
      {"ur10e",
       {{"J1", "tool 1 theta +1"},
        {"J2", "tool 2 theta +1"},
        {"J3", "tool 4 theta +1"},
        {"J4", "tool 6 theta +1"},
        {"J5", "tool 7 theta +1"},
        {"J6", "tool 8 theta +1"}}},
      {"xy_ball_bar", {{"X", "tool 1 X +1"}, {"Y", "tool 1 Y +1"}}},
      {"xy_circle", {{"X", "tool 1 X +1"}, {"Y", "tool 1 Y +1"}}},
      {"xy_hybrid_mill", {{"X", "workpiece 2 X -1"}, {"Y", "workpiece 1 Y -1"}, {"Z", "tool 1 Z +1"}}}};
  for (const std::string& name : diagnose_test::reference_machines()) {
    ASSERT_TRUE(expected.contains(name)) << name << ": a new reference machine, say what its axes move";
    const Machine machine = read_machine(machine_path(name));
    EXPECT_EQ(expected.at(name).size(), machine.axes.size()) << name;
    for (const auto& [axis, place] : expected.at(name)) EXPECT_EQ(place_text(machine, axis), place) << name;
  }
}

Machine small(const std::string& chain, const std::string& statics = "<a value=\"1e-4\" nominal=\"0\"/>") {
  return parse_machine("<machine><variables><static>" + statics +
                           "</static><machineaxes><X min=\"0\" max=\"100\"/><Y/><C rotary=\"true\"/>"
                           "</machineaxes></variables>" +
                           chain + "</machine>",
                       "m.xml");
}

TEST(OwnPlace, IsNotWhereAnErrorOfTheAxisActs) {
  // The squareness term is written first and stands at another length; the axis' own length is elsewhere.
  const Machine machine =
      small("<transforms><sixdof Y=\"a*X\"/><sixdof X=\"X\" Y=\"Y\" rZ=\"C\"/></transforms>");
  EXPECT_EQ(place_text(machine, "X"), "tool 2 X +1");
  EXPECT_EQ(place_text(machine, "Y"), "tool 2 Y +1");
  EXPECT_EQ(place_text(machine, "C"), "tool 2 rZ +1");
  EXPECT_EQ(AxisPlaces(machine).axis_of({false, 1, 4}), machine.find_axis("X"));
  EXPECT_FALSE(AxisPlaces(machine).axis_of({false, 0, 0}).has_value());
}

TEST(OwnPlace, IsNothingForAnAxisThatMovesNothing) {
  EXPECT_EQ(place_text(small("<transforms><sixdof X=\"a*X\" Y=\"Y\"/></transforms>"), "X"), "none");
}

TEST(BasePlaces, AreTheLengthsThatShiftTheMeasuringFrame) {
  const auto at = [](const Machine& machine) {
    std::string text;
    for (const DofPlace& place : base_places(machine))
      text += fmt::format("{}{}{} ", place.workpiece ? "w" : "t", place.transform, dof_name(machine, place));
    return text;
  };
  EXPECT_EQ(at(read_machine(machine_path("moving_bridge"))), "t0X t0Y t0Z ");
  EXPECT_EQ(at(read_machine(machine_path("column_moving_table"))), "w1X w1Y w1Z ");
  EXPECT_EQ(at(read_machine(machine_path("five_axis_bhead_ctable"))), "") << "its table turns";
  EXPECT_EQ(at(read_machine(machine_path("fibre_placement_dh"))), "")
      << "a DH transform has no three lengths";
  EXPECT_EQ(at(small("<transforms branch=\"workpiece\"><sixdof rZ=\"90\"/></transforms>"
                     "<transforms><sixdof X=\"X\"/></transforms>")),
            "")
      << "its lengths point elsewhere";
}

/// A step of 1 mm at each base place moves the point by 1 mm along the axis of that name: back in the
/// workpiece branch, which enters inverted.
TEST(BasePlaces, MoveThePointAlongTheirNames) {
  for (const char* name : {"moving_bridge", "column_moving_table", "fixed_bridge", "xy_hybrid_mill"}) {
    const std::string text = read_file(machine_path(name));
    const Machine machine = parse_machine(text, name);
    const Effect& effect = []() -> const Effect& {
      for (const Effect& one : built_in_effects())
        if (one.id == "tool-radius") return one;
      throw std::runtime_error("no tool-radius");
    }();
    Choice choice;
    choice.effect = &effect;
    choice.form = &effect.forms[0];
    const Candidate candidate = make_candidate(machine, choice);
    ASSERT_EQ(candidate.terms.size(), 3u);
    for (const CandidateTerm& term : candidate.terms)
      EXPECT_EQ(term.text[0] == '-', term.place.workpiece) << name << ": " << term.text;
  }
}

}  // namespace
}  // namespace vernier::places_test
