// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/machine.h"

namespace vernier::workbench {

/// Returns every name that an expression of a machine may use, with its unit and its meaning, for text
/// completion: [{name, unit, what}]. `candidates`: columns that the machine file does not use yet. The
/// command `add` declares these columns.
nlohmann::ordered_json expression_names(const model::Machine& machine);

/// Tests whether `text` is a valid term for a degree of freedom with the unit `unit` (mm or deg). In the
/// term, the name of the unknown coefficient is `k`. If `text` is not a valid expression of this machine,
/// returns {"ok", "message", "offset", "word"}. If `text` is a valid expression, returns {"ok": true, "unit"
/// of the expression without k, "k_unit": required unit of k, "warnings": units that do not match}. Units do
/// not scale a value (FORMATS section 1); units that do not match only cause warnings.
nlohmann::ordered_json check_term(const model::Machine& machine, const std::string& text,
                                  const std::string& unit);

}  // namespace vernier::workbench
