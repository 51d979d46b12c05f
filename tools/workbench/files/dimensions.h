// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::workbench {

/// Powers of mm, deg, degC, s, V, N, kg.
using UnitPowers = std::array<int, 8>;

/// Powers of a unit of FORMATS section 2 ("mm/s", "1/mm"); `nullopt` for any other unit.
std::optional<UnitPowers> unit_powers(const std::string& unit);
/// "mm/degC", "mm", "1" for no unit.
std::string unit_text(const UnitPowers& powers);

/// Returns the unit of an expression, with `unknown` taken as a pure number; `nullopt` if the unit is not
/// determined (a static without unit, a power that is no number). warnings: units that do not match.
std::optional<UnitPowers> expression_unit(const model::Machine& machine, const model::Expr& expr,
                                          const std::string& unknown, std::vector<std::string>& warnings);

}  // namespace vernier::workbench
