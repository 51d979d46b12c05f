// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/machine_sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/effects/candidate.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"

namespace vernier::tolerance_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

const char* const kMany = R"XML(<machine name="many"><variables><static><kx value="1e-4" nominal="0"/>
    <sxy value="1e-4" nominal="0"/><play value="0.01" nominal="0" unit="mm"/><tilt value="0.01" nominal="0" unit="deg"/>
    <off value="0.1" nominal="0" unit="mm"/><warm value="1e-5" nominal="0"/><late value="1e-3" nominal="0"/>
    <wa value="0.002" nominal="0" unit="mm"/><wb value="0.001" nominal="0" unit="mm"/><p value="5" Hide="true" unit="mm"/>
    <odd value="0.1" nominal="0"/><BaseShift/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
    <inputs><T unit="degC" reference="20"/></inputs>
    <comptables><table axis="Y" fit="X Y rZ"><station loc="0" X="0.01" Y="0.02" rZ="0.001"/><station loc="400"/></table>
    </comptables></variables><transforms branch="tool">
    <sixdof n="1" X="X+kx*X+play*dirX+warm*X*(T-20)+late*vX+wa*sin(360*X/p)+wb*cos(360*X/p)"/>
    <sixdof n="2" Y="Y+lYy" X="sxy*Y+lYx" rZ="rYz" rX="tilt"/>
    <sixdof n="3" Z="Z+off+odd*log(1+visit)*curv"/></transforms></machine>)XML";

TEST(MachineSources, AreCalledWhatTheCatalogueCallsThem) {
  const Machine machine = parse_machine(kMany, "m.xml");
  const std::vector<MachineSource> sources =
      machine_sources(machine, ParameterSet(machine, {}), built_in_effects());
  std::vector<std::string> names;
  for (const MachineSource& source : sources) names.push_back(source.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "scale-error of X in X", "squareness of Y in X", "backlash of X in X",
                         "axis-tilt in rX of the carriage of Y", "offset in Z of the carriage of Z",
                         "thermal-scale of X in X", "servo-lag of X in X", "cyclic-error of X in X",
                         "custom in Z of the carriage of Z", "straightness of Y in X",
                         "positioning-error of Y in Y", "angular-error of Y in rZ"));
}

TEST(MachineSources, CountEveryParameterOnce) {
  const Machine machine = parse_machine(kMany, "m.xml");
  const ParameterSet parameters(machine, {});
  std::vector<int> seen(parameters.size(), 0);
  for (const MachineSource& source : machine_sources(machine, parameters, built_in_effects()))
    for (const std::size_t p : source.parameters) ++seen[p];
  EXPECT_THAT(seen, testing::Each(1));
}

TEST(MachineSources, WithoutAllOfThemTheMachineIsNominal) {
  Machine machine = parse_machine(kMany, "m.xml");
  const std::vector<MachineSource> sources =
      machine_sources(machine, ParameterSet(machine, {}), built_in_effects());
  for (const MachineSource& source : sources) machine = without_source(machine, source);
  States at = make_states(1, 3, {25});
  at.axis[0][0] = 123, at.axis[1][0] = 99, at.direction[0][0] = 1, at.velocity[0][0] = 7;
  at.curvature[0] = 0.1, at.visit[0] = 3;
  EXPECT_LT(deviation(machine, at).norm(), 1e-12);  // rounding
}

}  // namespace
}  // namespace vernier::tolerance_test
