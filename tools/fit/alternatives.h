// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/readings_beside_set_up.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// Other terms that explain the fit rows as well as terms of the fitted model, to within three standard
/// deviations in all, beside a free set-up. Two kinds are looked for:
/// - a wave along an axis (a sine or cosine of it with a free static): a slower wave in the same degree of
///   freedom, where the positions measured are those of a grid or nearly so (spectral window above 0.7);
/// - a turn (an angle with a free static): a shift in the three lengths of the same transform, where the rows
///   read no rotation. With one tool and no axis behind it both are the same. tool.
std::vector<model::FitRecord::Alternative> find_alternatives(const ReadingsBesideSetUp& readings);

/// The model's term less its alternative at each state, as what it moves the tool point by: 3 N, mm; zero
/// where the machine has no such transform. machine: without BaseShifts. tool.
Eigen::VectorXd alternative_column(const model::Machine& machine,
                                   const model::FitRecord::Alternative& alternative,
                                   const model::States& states);

}  // namespace vernier::fit
