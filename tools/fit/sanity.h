// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Limit for the residual divided by the reach of the machine. If residual divided by reach exceeds the
/// limit, the readings do not belong to the machine. Typical values of residual divided by reach are 1e-5 for
/// machine tools and 1e-2 for robots made by hand.
inline constexpr double kAbsurdResidual = 0.02;

/// Limit for the misfit divided by the reach. If misfit divided by reach exceeds the limit, known mistakes
/// (for example a wrong unit) are tested on the nominal machine.
inline constexpr double kFarOff = 0.05;

/// Standard uncertainty of a length reading, um, that no instrument reaches: a smaller u is in another unit,
/// such as up to 50 um stated as mm in a column of um.
inline constexpr double kSmallestU_um = 0.05;

/// Returns the reading with the largest residual. `check`: true selects the check rows; false selects the fit
/// rows.
WorstReading worst_reading(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                           bool check);

struct LikelyMistake {
  std::string sentence;      // empty: no mistake was found
  bool one_reading = false;  // true: one gross reading among good readings; false: a mistake of all rows
};

/// Returns one sentence with the reason why the readings do not belong to this machine: one gross reading,
/// two swapped columns, a wrong unit or a wrong sign. likely_mistake tests each of these mistakes. A mistake
/// is accepted if its correction reduces the misfit of the nominal machine by a factor of five. `plausible`:
/// true if a real machine can have a residual of this size. After the correction of a mistake, the nominal
/// machine must explain the readings. A unit that only makes a deflection small is therefore not accepted as
/// a mistake.
LikelyMistake likely_mistake(const model::Machine& machine, const model::Measurement& rows,
                             const WorstReading& worst, bool plausible);

/// Returns a sentence if the machine file has no set-up and a set-up reduces the misfit of the nominal
/// machine to less than a fifth of `misfit_mm`; otherwise an empty text. `misfit_mm`: misfit without set-up.
/// If the machine file has a set-up, the sentence is about files that agree with the machine only one by one.
/// The test for a missing set-up is for fits that failed, because free parameters of a machine can replace a
/// set-up.
std::string missing_set_up(const model::Machine& machine, const model::Measurement& rows, double misfit_mm);

/// Returns a sentence if the residual of a file is hundreds of times the standard uncertainty u of its
/// readings, and this u is below kSmallestU_um: probably u is in another unit. Otherwise an empty text.
std::string unbelievable_u(const model::Measurement& measurement, const Eigen::VectorXd& residual);

/// Tests for a collapsed machine: touches of unknown points agree best if the machine does not move the tool
/// at all. Returns the reason if the fitted machine moves the tool, in any direction, much less than the
/// nominal machine does; otherwise an empty text.
std::string collapse_of(const model::Machine& fitted, const model::ParameterSet& parameters,
                        const model::Measurement& measurement);

/// Returns a sentence if a fit of touches gave a machine far from the machine file; otherwise an empty text.
/// Limits: a constant turned by more than 45 deg or moved by more than a quarter of the reach, or the motion
/// of a linear axis over its travel changed by 5 %.
std::string far_from_nominal(const model::Machine& fitted, const model::ParameterSet& parameters,
                             const model::Measurement& measurement, double reach_mm);

/// Returns half of the diagonal of the declared ranges of the linear axes, mm; 0 if no ranges are declared.
double half_travel_mm(const model::Machine& machine);

}  // namespace vernier::fit
