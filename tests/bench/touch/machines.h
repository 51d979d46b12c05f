// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated machines that are calibrated by touching things, and their surveys.
#pragma once
#include <Eigen/Core>
#include <random>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::touch_bench {

/// A survey of a simulated machine, and what it should reach.
struct Case {
  std::string name;
  std::string machine;                  // text of the nominal machine file, with its artefacts
  std::string survey;                   // text of the measurement file
  model::Machine truth;                 // the machine that was surveyed
  model::States fresh;                  // poses that no fit saw; empty: parameters are judged
  std::vector<std::string> parameters;  // judged if there are no fresh poses
  double unit = 1;                      // factor of the judged numbers: mm -> um, deg -> urad
  double goal = 0;                      // mean error, in that unit
};

/// A robot arm and two sockets of unknown place, 20 poses each, u 0.02 mm. known: how the size is known.
enum class Size { kNothing, kDistance, kPlaces };
Case robot(std::mt19937_64& random, Size known);
/// A mill and one ball at four places of a plate, with two tool lengths, u 1 um.
Case mill(std::mt19937_64& random);
/// A table with two rotary axes, and one ball of unknown place at 12 poses of the table, u 1 um.
Case table(std::mt19937_64& random);
/// `touches` touches of `things` spheres with the mill.
Case many(std::mt19937_64& random, int things, int touches);

}  // namespace vernier::touch_bench
