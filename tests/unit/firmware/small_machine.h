// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/compile/compile.h"
#include "tools/model/machine_reader.h"

namespace vernier {

using namespace vernier::compile;
using namespace vernier::model;

/// Two axes and a thermometer: deviation of X is 10 um/100 mm of scale and 4 um of backlash, of Y 20 um per
/// degC at the far end. X may be corrected by 30 um (so that it saturates beyond 260 mm), Y by 1 mm.
inline constexpr const char* kSmallMachine = R"xml(<machine name="small">
  <variables>
    <static>
      <k value="0.0001" nominal="0" unit=""/>
      <bl value="0.004" nominal="0" unit="mm"/>
      <cte value="0.0001" nominal="0" unit=""/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600" maxcorrection="0.03" maxslew="0.5"/>
      <Y rotary="false" min="0" max="200" maxcorrection="1" maxslew="2"/>
    </machineaxes>
    <inputs><T unit="degC" reference="20"/></inputs>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X+k*X+bl*dirX" Y="Y+cte*Y*(T-20)" Z="0" rX="0" rY="0" rZ="0"/>
  </transforms>
</machine>)xml";

/// Slew limits of its axes in counts (nm) a tick: 0.5 and 2 mm/s at 1 kHz.
inline constexpr std::int64_t kSmallSlewX = 500, kSmallSlewY = 2000;

inline std::unique_ptr<LoadedImage> small_image() {
  const std::string text = kSmallMachine;
  const Machine machine = parse_machine(text, "small.xml");
  return load_image(compile_machine(machine, text, {}).image, machine);
}

}  // namespace vernier
