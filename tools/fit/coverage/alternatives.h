// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/coverage/readings_beside_set_up.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// A motion of the tool point below this limit is negligible, mm.
inline constexpr double kNothing_mm = 5e-5;

/// Finds alternative terms: terms that explain the fit rows as well as terms of the fitted model, if the
/// set-up is free. Two explanations are equally good if they differ by at most three standard deviations in
/// all. There are two kinds of alternative terms:
/// - for a cyclic error along an axis (a sine or cosine of the position with a free static): a term with a
/// longer period in the same degree of freedom, if the measured positions are on a grid or nearly on a grid
/// (spectral window above 0.7);
/// - for a rotation (an angle with a free static): a shift in the three lengths of the same
/// transform, if the rows read no rotation. With only one tool, and no axis between transform and tool, the
/// rotation and the shift have the same effect on the readings.
std::vector<model::FitRecord::Alternative> find_alternatives(const ReadingsBesideSetUp& readings);

/// Returns the motion of the tool point by a term of the model minus the motion by its alternative term, at
/// each state: 3 N elements, mm. The result of alternative_column() is zero if the machine does not have the
/// transform of the term. `machine`: a machine without BaseShifts.
Eigen::VectorXd alternative_column(const model::Machine& machine,
                                   const model::FitRecord::Alternative& alternative,
                                   const model::States& states);

}  // namespace vernier::fit
