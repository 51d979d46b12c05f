// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "tools/model/expression.h"

namespace vernier::effects {

/// Number and approach direction that multiply a parameter in an expression: 1 and "dirX" for k in "k*dirX",
/// -0.5 and "dirX" in "Z-k*dirX/2".
struct DirectionCoefficient {
  double factor = 1;
  std::string direction;
};

/// Returns the factor of a parameter in the terms of a sum that contain only numbers, the parameter and one
/// approach direction. The half of the reversal value of ISO 230-2 is the parameter times this factor. Other
/// terms of the sum (k*dirX*X) are ignored. nullopt: the expression has no such term, or these terms have
/// different directions. `name`: name of the parameter.
std::optional<DirectionCoefficient> direction_coefficient(const model::Expr& expression,
                                                          const std::string& name);

}  // namespace vernier::effects
