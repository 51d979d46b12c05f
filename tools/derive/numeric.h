// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/derive/error_equation.h"
#include "tools/model/states.h"

namespace vernier::derive {

/// Returns the sensitivities of the error equation at the state `row`: 6 x parameters, mm and rad per unit of
/// each parameter.
Eigen::MatrixXd sensitivity_at(const ErrorEquation& equation, const model::States& states, std::size_t row);

/// Returns a machine with the given error values (in the units of the parameters): statics changed from their
/// nominal, constant tables, scale factors. The function with_errors is used to compare the equation with the
/// chain.
model::Machine with_errors(const ErrorEquation& equation, const Eigen::VectorXd& errors);

}  // namespace vernier::derive
