// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/probe_offset.h"

#include <gtest/gtest.h>

#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"

namespace vernier::probe_offset_test {

using namespace vernier::effects;
namespace {

const std::string kMachine =
    R"xml(<machine name="m"><variables><static><k value="0.1" nominal="0" unit="deg"/></static>
  <machineaxes><X min="0" max="200"/><Z min="0" max="100"/></machineaxes><artefact name="bed" type="plane"/></variables>
  <transforms branch="tool"><sixdof n="1" X="X" Z="Z" rX="k"/></transforms></machine>)xml";

model::CompletedText declared(const std::string& rows, const std::string& text = kMachine) {
  const model::Machine machine = model::parse_machine(text, "m.xml");
  return with_probe_offset(text, machine, model::parse_measurement(rows, "bed.csv", machine));
}

TEST(ProbeOffset, OfTheRowsIsATransformAfterTheTool) {
  const std::string rows = "X[mm],Z[mm],probeX[mm],probeY[mm],on\n0,0,-30,20,bed\n9,0,-30,20,bed\n";
  const model::CompletedText probe = declared(rows);
  ASSERT_EQ(probe.notes.size(), 1U);
  const model::Machine machine = model::parse_machine(probe.text, "m.xml");
  const model::Measurement read = model::parse_measurement(rows, "bed.csv", machine);
  const Eigen::Vector3d point = model::forward(machine, read.states).position.col(0);
  EXPECT_DOUBLE_EQ(point.x(), -30);
  EXPECT_NEAR(point.z(), 20 * 0.1 / 57.29578, 1e-6);  // the roll k lifts the probe, not the tool point
  // A command without these columns is about the tool point.
  EXPECT_EQ(model::forward(machine, model::make_states(1, machine)).position.col(0).norm(), 0);
  EXPECT_EQ(declared(rows, probe.text).text, probe.text);
  EXPECT_FALSE(machine.find_static("probe_height"));
}

TEST(ProbeOffset, BesideTouchesOfTheToolPointTheHeightOfTheProbeIsFree) {
  const model::CompletedText probe =
      declared("X[mm],Z[mm],probeX[mm],probeY[mm],on\n0,0,-30,20,bed\n9,0,0,0,bed\n");
  ASSERT_EQ(probe.notes.size(), 2U);
  model::Machine machine = model::parse_machine(probe.text, "m.xml");
  machine.statics[*machine.find_static("probe_height")].value = 2;
  model::States states = model::make_states(2, machine);
  states.input[*machine.find_input("probeX")][1] = -30;
  const Eigen::Matrix3Xd points = model::forward(machine, states).position;
  EXPECT_DOUBLE_EQ(points(2, 0), 0);
  EXPECT_NEAR(points(2, 1), 2, 1e-5);  // by the cosine of k
}

TEST(ProbeOffset, RowsWithoutAProbeDoNotChangeTheMachine) {
  EXPECT_EQ(declared("X[mm],Z[mm],on\n0,0,bed\n9,0,bed\n").text, kMachine);
  EXPECT_EQ(declared("X[mm],Z[mm],probeX[mm],probeY[mm],on\n0,0,0,0,bed\n9,0,0,0,bed\n").text, kMachine);
}

}  // namespace
}  // namespace vernier::probe_offset_test
