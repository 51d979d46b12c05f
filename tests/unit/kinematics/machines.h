// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <random>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/states.h"
#include "tools/text/numbers.h"

namespace vernier {

using namespace vernier::model;
using namespace vernier::text;

/// Six joints of a common industrial arm (Denavit-Hartenberg lengths in mm), tool along its last z.
inline Machine robot() {
  return parse_machine(R"XML(<machine name="arm"><variables>
  <static><b1 value="0.01" nominal="0"/><l2 value="-612.4" nominal="-612.7"/></static>
  <machineaxes>
    <J1 rotary="true" min="-180" max="180"/><J2 rotary="true" min="-180" max="180"/>
    <J3 rotary="true" min="-180" max="180"/><J4 rotary="true" min="-180" max="180"/>
    <J5 rotary="true" min="-180" max="180"/><J6 rotary="true" min="-180" max="180"/>
  </machineaxes></variables>
  <transforms branch="tool">
    <DH n="1" theta="J1" d="180.7" a="0" alpha="90"/>
    <DH n="2" theta="J2+b1" d="0" a="l2" alpha="0"/>
    <DH n="3" theta="J3" d="0" a="-571.55" alpha="0"/>
    <DH n="4" theta="J4" d="174.15" a="0" alpha="90"/>
    <DH n="5" theta="J5" d="119.85" a="0" alpha="-90"/>
    <DH n="6" theta="J6" d="116.55" a="0" alpha="0"/>
  </transforms></machine>)XML",
                       "arm.xml");
}

/// The column machine: table on Y and X slides, tool on the Z slide, eighteen errors and three squareness
/// values of the size that machines have (mm, rad).
inline Machine column_machine(std::mt19937_64& random) {
  std::uniform_real_distribution<double> length(-0.01, 0.01), angle(-5e-5, 5e-5);
  std::string statics;
  for (const char* slide : {"X", "Y", "Z"}) {
    for (const char* d : {"EX", "EY", "EZ"})
      statics +=
          std::string("<") + d + slide + " value=\"" + number_text(length(random)) + "\" nominal=\"0\"/>";
    for (const char* d : {"EA", "EB", "EC"})
      statics +=
          std::string("<") + d + slide + " value=\"" + number_text(angle(random)) + "\" nominal=\"0\"/>";
  }
  for (const char* name : {"AL", "B1", "B2"})
    statics += std::string("<") + name + " value=\"" + number_text(angle(random)) + "\" nominal=\"0\"/>";
  const std::string angles =
      " rX=\"57.29577951308232*EA#\" rY=\"57.29577951308232*EB#\" rZ=\"57.29577951308232*EC#\"/>";
  const auto slide = [&](int n, const std::string& lengths, char name) {
    std::string text = "<sixdof n=\"" + std::to_string(n) + "\" " + lengths + angles;
    for (auto at = text.find('#'); at != std::string::npos; at = text.find('#')) text[at] = name;
    return text;
  };
  return parse_machine(
      "<machine name=\"column\"><variables><static>" + statics +
          "</static><machineaxes><X min=\"-300\" max=\"300\"/><Y min=\"-300\" max=\"300\"/>"
          "<Z min=\"0\" max=\"300\"/></machineaxes></variables><transforms branch=\"workpiece\">" +
          slide(1, "X=\"EXY\" Y=\"Y+EYY\" Z=\"EZY\"", 'Y') +
          slide(2, "X=\"X+EXX\" Y=\"EYX-AL*X\" Z=\"EZX\"", 'X') +
          "</transforms><transforms branch=\"tool\">" +
          slide(1, "X=\"EXZ-B1*Z\" Y=\"EYZ-B2*Z\" Z=\"Z+EZZ\"", 'Z') +
          "<sixdof n=\"9\" X=\"-105.5\" Y=\"80\" Z=\"-91.3\"/></transforms></machine>",
      "column.xml");
}

/// `count` random states within the axis ranges; axes without a range within +-`reach`.
inline States random_states(const Machine& machine, std::size_t count, std::mt19937_64& random,
                            double reach = 60) {
  States states = make_states(count, machine);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    std::uniform_real_distribution<double> value(machine.axes[a].min.value_or(-reach),
                                                 machine.axes[a].max.value_or(reach));
    for (Eigen::Index i = 0; i < states.axis[a].size(); ++i) states.axis[a][i] = value(random);
  }
  return states;
}

}  // namespace vernier
