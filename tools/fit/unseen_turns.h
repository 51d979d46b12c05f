// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/problem.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Which parameters are turns of a BaseShift that the readings see to the second order only: what they do to
/// the first is nothing, or what the shift's lengths do as well. One coordinate along one line (a laser
/// interferometer, a dial gauge) sees none; its cosine error stood for the axis' scale, along a valley in
/// which a fit did not come to an end. reach_mm: size of the machine (convention.cpp). tool.
std::vector<bool> unseen_turns(const model::Machine& machine, const model::Measurement& rows,
                               const model::ParameterSet& parameters, double reach_mm);

/// Keeps these parameters where `at` has them: as if known to a millionth of a degree there. tool.
void hold_at(FitProblem& problem, const std::vector<bool>& held, const Eigen::VectorXd& at);

}  // namespace vernier::fit
