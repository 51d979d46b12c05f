// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/model/machine_reader.h"

namespace vernier::bridge_to_plan {

/// A bridge with squareness, a scale, play, a table of Y and a set-up, all at zero.
inline constexpr const char* kBridge =
    R"XML(<machine name="bridge"><variables><static><sxy value="0" nominal="0"/>
    <szx value="0" nominal="0"/><kx value="0" nominal="0"/><play value="0" nominal="0" unit="mm"/><BaseShift/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
    <comptables><table axis="Y" fit="X Z rZ"><station loc="0"/><station loc="200"/><station loc="400"/></table>
    </comptables></variables>
    <transforms branch="tool"><sixdof n="1" X="X+kx*X+play*dirX"/><sixdof n="2" Y="Y" X="sxy*Y+lYx" Z="lYz" rZ="rYz"/>
    <sixdof n="3" Z="Z" X="szx*Z"/></transforms></machine>)XML";

inline model::Machine bridge() { return model::parse_machine(kBridge, "m.xml"); }

}  // namespace vernier::bridge_to_plan
