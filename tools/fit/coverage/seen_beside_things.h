// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// What the readings of the fit rows show of each parameter, if the unknown values of the touched objects
/// (`same`, `on`) follow it.
struct SeenBesideThings {
  /// Share (0 to 1) of the effect on the readings that is left. An unknown point that was touched four times
  /// at one pose follows every error of the machine: share 0. 1 for a parameter without effect.
  Eigen::VectorXd share;
  /// Sum of squares of what is left, with the weights of a fit, per square of the parameter's unit.
  Eigen::VectorXd squares;
};
SeenBesideThings seen_beside_things(const model::Machine& machine, const model::Measurement& rows,
                                    const model::ParameterSet& parameters);

}  // namespace vernier::fit
