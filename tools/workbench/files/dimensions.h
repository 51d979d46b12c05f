// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::workbench {

/// Exponents of the base units mm, deg, degC, s, V, N, kg in a unit.
using UnitPowers = std::array<int, 8>;

/// Returns the exponents of a unit of FORMATS section 2 ("mm/s", "1/mm"); nullopt for any other unit.
std::optional<UnitPowers> unit_powers(const std::string& unit);
/// Returns the text of a unit: "mm/degC", "mm"; "1" for a pure number.
std::string unit_text(const UnitPowers& powers);

/// Returns the unit of an expression in which `unknown` counts as a pure number. The function
/// expression_unit() returns nullopt if the unit is not determined (a static without unit, an exponent that
/// is not a number). `warnings`: receives messages about units that do not match.
std::optional<UnitPowers> expression_unit(const model::Machine& machine, const model::Expr& expr,
                                          const std::string& unknown, std::vector<std::string>& warnings);

}  // namespace vernier::workbench
