// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>

#include "tests/unit/compile/poses.h"
#include "tools/compile/orientation.h"
#include "tools/kinematics/correction.h"

namespace vernier {

using namespace vernier::compile;
using namespace vernier::kinematics;
using namespace vernier::model;

/// What the double chain is left with where the axes stand as the executed fixed-point program asks for.
struct LeftOver {
  double before_um = 0, left_um = 0;         // tool point, largest
  double tilt_before_deg = 0, tilt_deg = 0;  // tool direction, largest where not damped
  double damped_tilt_deg = 0;                // largest where damped
  std::size_t damped = 0;                    // poses
  std::vector<double> largest;               // correction of each axis, mm or deg
};

/// Corrections of consecutive ticks as the output stage rounds them, before the board's limits.
inline States corrected_states(const TestMachine& test, const std::vector<CycleInput>& inputs,
                               const States& states) {
  States result = states;
  Compensator compensator(test.loaded->view.program());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    compensator.step(inputs[i]);
    for (std::size_t k = 0; k < test.compiled.program.outputs.size(); ++k)
      result.axis[test.compiled.program.outputs[k].axis][static_cast<Eigen::Index>(i)] -=
          test.deviation_units(compensator, k);
  }
  return result;
}

/// p_actual(q + c) against p_nominal(q), by forward solutions that share nothing with the compiler.
inline LeftOver left_over(const TestMachine& test, std::size_t poses, unsigned seed) {
  std::mt19937_64 random(seed);
  const std::vector<CycleInput> inputs = test.random_poses(poses, random);
  const States states = test.states_of(inputs), corrected = corrected_states(test, inputs, states);
  const Poses nominal = forward(nominal_machine(test.machine), states),
              before = forward(test.machine, states), after = forward(test.machine, corrected);
  const Column tilt_before = tilt_between(before, nominal), tilt = tilt_between(after, nominal);
  const std::vector<bool> damped = damped_poses(test.machine, states);
  LeftOver left;
  left.before_um = 1000 * (before.position - nominal.position).colwise().norm().maxCoeff();
  left.left_um = 1000 * (after.position - nominal.position).colwise().norm().maxCoeff();
  left.tilt_before_deg = tilt_before.maxCoeff();
  for (std::size_t i = 0; i < poses; ++i) {
    double& worst = damped[i] ? left.damped_tilt_deg : left.tilt_deg;
    worst = std::max(worst, tilt[static_cast<Eigen::Index>(i)]);
    left.damped += damped[i] ? 1 : 0;
  }
  for (std::size_t a = 0; a < states.axis.size(); ++a)
    left.largest.push_back((corrected.axis[a] - states.axis[a]).abs().maxCoeff());
  return left;
}

}  // namespace vernier
