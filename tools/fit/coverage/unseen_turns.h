// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/least_squares/problem.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Returns one flag for each parameter: true if the parameter is a rotation of a BaseShift that affects the
/// readings only in second order. The first-order effect of an unseen rotation on the readings is zero, or
/// equals the effect of the lengths of the shift. Example: an instrument that measures one coordinate along
/// one line (a laser interferometer, a dial gauge). The cosine error of an unseen rotation cannot be
/// distinguished from the scale of the axis, and a fit of both does not converge. `reach_mm`: size of the
/// machine (convention.cpp).
std::vector<bool> unseen_turns(const model::Machine& machine, const model::Measurement& rows,
                               const model::ParameterSet& parameters, double reach_mm);

/// Standard uncertainty of a set-up rotation that the fit holds fixed. A rotation by this
/// uncertainty moves a point at 1 m by 0.02 um, far below the uncertainty of any reading.
inline constexpr double kHeldTurn_deg = 1e-6;

/// Fixes the parameters `held` at their values in `at`, with a standard uncertainty of a millionth of a
/// degree.
void hold_at(FitProblem& problem, const std::vector<bool>& held, const Eigen::VectorXd& at);

}  // namespace vernier::fit
