// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/coverage/readings_beside_set_up.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// A smaller motion of the tool is negligible, mm.
inline constexpr double kNothing_mm = 5e-5;

/// Finds other terms that, with a free set-up, explain the fit rows as well as terms of the fitted model. "As
/// well" means within three standard deviations in all. Two kinds of alternative terms are searched:
/// - for a cyclic error along an axis (a sine or cosine of the position with a free static): a term with a
/// longer period in the same degree of freedom, if the measured positions are on a grid or nearly on a grid
/// (spectral window above 0.7);
/// - for a rotation (an angle with a free static): a shift in the three lengths of the same
/// transform, if the rows read no rotation. With one tool and no axis behind the transform, the rotation and
/// the shift have the same effect.
std::vector<model::FitRecord::Alternative> find_alternatives(const ReadingsBesideSetUp& readings);

/// Returns the motion of the tool point by the model's term minus the motion by its alternative, at each
/// state: 3 N, mm. The result is zero if the machine has no such transform. machine: without BaseShifts.
Eigen::VectorXd alternative_column(const model::Machine& machine,
                                   const model::FitRecord::Alternative& alternative,
                                   const model::States& states);

}  // namespace vernier::fit
