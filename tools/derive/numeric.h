// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/derive/error_equation.h"
#include "tools/model/states.h"

namespace vernier::derive {

/// Returns the equation's sensitivities at state `row` of the machine: 6 x parameters, mm and rad
/// per unit of each.
Eigen::MatrixXd sensitivity_at(const ErrorEquation& equation, const model::States& states, std::size_t row);

/// Returns a machine with these error values (in the units of the parameters): statics changed from their
/// nominal, constant tables, scale factors. with_errors serves to compare the equation with the chain.
model::Machine with_errors(const ErrorEquation& equation, const Eigen::VectorXd& errors);

}  // namespace vernier::derive
