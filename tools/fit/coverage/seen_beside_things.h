// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Effect of each parameter on the readings of the fit rows, if the unknown values of the touched objects
/// (`same`, `on`) are fitted too.
struct SeenBesideThings {
  /// Share (0 to 1) of a parameter's effect on the readings that remains after the fit of the touched
  /// objects. Example: an unknown point is touched four times at one pose. The fitted point explains every
  /// error of the machine, so that the share is 0. The share is 0 for a parameter without effect on the
  /// readings.
  Eigen::VectorXd share;
  /// Sum of squares of the remaining effect on the readings, with the weights of a fit, per square of the
  /// parameter's unit.
  Eigen::VectorXd squares;
};
SeenBesideThings seen_beside_things(const model::Machine& machine, const model::Measurement& rows,
                                    const model::ParameterSet& parameters);

}  // namespace vernier::fit
