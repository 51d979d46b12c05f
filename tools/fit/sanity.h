// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// A model that leaves more of the readings than this share of what it reaches has not been measured: they
/// are of something else. Machines leave 1e-5, hand-made robots 1e-2.
inline constexpr double kAbsurdResidual = 0.02;

/// Beyond this share of the reach the nominal machine is asked whether a known mistake explains it.
inline constexpr double kFarOff = 0.05;

/// `check`: of which role.
WorstReading worst_reading(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                           bool check);

struct LikelyMistake {
  std::string sentence;      // empty: nothing found
  bool one_reading = false;  // a gross reading among good ones, no mistake of all rows
};

/// Why readings are not those of this machine, in a sentence: one gross reading, two columns swapped, a unit,
/// a sign. Each is tried; what lowers the misfit of the nominal machine fivefold is it. tool.
LikelyMistake likely_mistake(const model::Machine& machine, const model::Measurement& rows,
                             const WorstReading& worst);

}  // namespace vernier::fit
