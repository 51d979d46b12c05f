// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine_reader.h"
#include "tools/model/states.h"

namespace vernier::offline_test {

using namespace vernier::model;

/// A bridge with squareness, a bent table, a cyclic error and play: up to 80 um.
inline Machine bridge() {
  return parse_machine(R"XML(<machine name="bridge"><variables><static><sq value="1e-4" nominal="0"/>
    <play value="0.002" nominal="0" unit="mm"/><cyc value="0.004" nominal="0" unit="mm"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
    <comptables><table axis="X"><station loc="0"/><station loc="150" Y="0.03" rZ="0.002"/>
      <station loc="400" X="0.02" Y="-0.01" rX="0.003"/><station loc="600"/></table></comptables></variables>
    <transforms branch="tool"><sixdof n="1" X="X+lXx+cyc*sin(360*X/20)" Y="lXy" rX="rXx" rZ="rXz"/>
      <sixdof n="2" Y="Y+play*dirY" X="sq*Y"/><sixdof n="3" Z="Z"/><sixdof n="4" Z="-80" Y="30"/></transforms></machine>)XML",
                       "bridge.xml");
}

inline States at_rest(const Machine& machine) { return make_states(1, machine.axes.size(), {}); }

}  // namespace vernier::offline_test
