// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Limit of the residual divided by the reach of the model: above this share, the readings do not belong to
/// the machine. Machines have 1e-5, hand-made robots 1e-2.
inline constexpr double kAbsurdResidual = 0.02;

/// Limit of the misfit as a share of the reach: above this limit, known mistakes are tried on the nominal
/// machine.
inline constexpr double kFarOff = 0.05;

/// `check`: the role of the rows.
WorstReading worst_reading(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                           bool check);

struct LikelyMistake {
  std::string sentence;      // empty: no mistake found
  bool one_reading = false;  // a gross reading among good ones, not a mistake of all rows
};

/// Returns the reason why readings do not belong to this machine, in one sentence: one gross reading, two
/// columns swapped, a unit, a sign. Each of these mistakes is tried. A mistake is accepted if its correction
/// reduces the misfit of the nominal machine fivefold. `plausible`: a machine may have a residual of this
/// size. After the correction of the mistake the nominal machine must explain the readings: a unit that only
/// makes a deflection small is not accepted.
LikelyMistake likely_mistake(const model::Machine& machine, const model::Measurement& rows,
                             const WorstReading& worst, bool plausible);

/// Returns the sentence for a machine file without a set-up whose nominal machine fits the readings much
/// better with one (a fifth of misfit_mm, its misfit without); else empty. For fits that failed: free
/// parameters of a machine can replace a set-up.
std::string missing_set_up(const model::Machine& machine, const model::Measurement& rows, double misfit_mm);

/// Touches of unknown points agree best if the machine does not move at all. Returns the reason if a fit of
/// such readings gave a machine that moves the tool much less than the nominal one, in any direction; else
/// empty.
std::string collapse_of(const model::Machine& fitted, const model::ParameterSet& parameters,
                        const model::Measurement& measurement);

/// Returns the sentence for a fit of touches whose machine is another one than that of the file: a constant
/// that turned by more than 45 deg or moved by more than a quarter of the reach, or a linear axis whose
/// motion is 5 % more or less over the travel of the axes; else empty.
std::string far_from_nominal(const model::Machine& fitted, const model::ParameterSet& parameters,
                             const model::Measurement& measurement, double reach_mm);

/// Returns half of the diagonal of the declared ranges of the linear axes, mm; 0 without ranges.
double half_travel_mm(const model::Machine& machine);

}  // namespace vernier::fit
