// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/least_squares/problem.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Returns which parameters are rotations of a BaseShift that the readings show only in second
/// order. Their first-order effect is zero, or is the same as that of the shift's lengths. An
/// example is one coordinate along one line (a laser interferometer, a dial gauge). Its cosine
/// error was confused with the axis' scale, along a valley in which a fit did not converge.
/// reach_mm: size of the machine (convention.cpp). tool.
std::vector<bool> unseen_turns(const model::Machine& machine, const model::Measurement& rows,
                               const model::ParameterSet& parameters, double reach_mm);

/// Holds these parameters at their values in `at`, as if known to a millionth of a degree. tool.
void hold_at(FitProblem& problem, const std::vector<bool>& held, const Eigen::VectorXd& at);

}  // namespace vernier::fit
