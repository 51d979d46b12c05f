// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <memory>
#include <string>

#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/parameters.h"
#include "tools/model/states.h"

namespace vernier::tolerance_test {

/// Three axes with a scale error, a squareness, a reversal error and a table.
inline model::Machine plate_machine(double kx, double sxy, double play = 0) {
  model::Machine machine = model::parse_machine(
      R"XML(<machine name="plate"><variables><static><kx value="0" nominal="0"/><sxy value="0" nominal="0"/>
      <play value="0" nominal="0" unit="mm"/><tilt value="0" nominal="0" unit="deg"/><BaseShift/></static>
      <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
      <comptables><table axis="Z" fit="X rY"><station loc="-300"/><station loc="0"/></table></comptables></variables>
      <transforms branch="tool"><sixdof n="1" X="X+kx*X+play*dirX"/><sixdof n="2" Y="Y" X="sxy*Y" rX="tilt"/>
      <sixdof n="3" Z="Z" X="lZx" rY="rZy"/></transforms></machine>)XML",
      "plate.xml");
  machine.statics[0].value = kx;
  machine.statics[1].value = sxy;
  machine.statics[2].value = play;
  return machine;
}

/// As if a fit had left it: standard uncertainty of the scale and the squareness; `open`: of the scale's
/// variance, that no reading bore on.
inline void set_known(model::Machine& machine, double std_kx, double std_sxy, double open = 0) {
  auto record = std::make_shared<model::FitRecord>();
  model::Machine bare = machine;
  bare.base_shifts.clear();
  const model::ParameterSet own(bare, {});
  record->values = own.get(bare);
  const auto n = static_cast<Eigen::Index>(own.size());
  record->factor = Eigen::MatrixXd::Zero(n, n);
  record->open = Eigen::MatrixXd::Zero(n, open > 0 ? 1 : 0);
  record->open_known = true;
  for (std::size_t i = 0; i < own.size(); ++i) {
    record->parameters.push_back(own[i].name);
    const auto at = static_cast<Eigen::Index>(i);
    if (own[i].name == "kx") record->factor(at, at) = std_kx;
    if (own[i].name == "sxy") record->factor(at, at) = std_sxy;
    if (own[i].name == "kx" && open > 0) record->open(at, 0) = std::sqrt(open) * std_kx;
  }
  record->measured = {{"X", 0, 600}, {"Y", 0, 400}, {"Z", -300, 0}};
  machine.fitted = record;
}

inline model::States at_rest(const model::Machine& machine) {
  return model::make_states(1, machine.axes.size(), {});
}

inline const char* const kBores =
    "feature,kind,x,y,z,diameter,length,position,size,form,datum\n"
    "first,cylinder,100,100,-100,40,,,0.01,0.01,yes\n"
    "second,cylinder,300,200,-100,40,,0.1,0.01,0.01,yes\n"
    "third,cylinder,200,100,-100,40,,0.1,0.01,0.01,\n";

}  // namespace vernier::tolerance_test
