// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/derive/error_equation.h"
#include "tools/model/states.h"

namespace vernier::derive {

/// The equation's sensitivities at state `row` of the machine: 6 x parameters, mm and rad per unit of each.
/// tool.
Eigen::MatrixXd sensitivity_at(const ErrorEquation& equation, const model::States& states, std::size_t row);

/// A machine whose errors have these values (in the units of the parameters): statics moved from their
/// nominal, tables constant, scale factors. For checks of the equation against the chain itself. tool.
model::Machine with_errors(const ErrorEquation& equation, const Eigen::VectorXd& errors);

}  // namespace vernier::derive
