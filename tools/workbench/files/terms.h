// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/machine.h"

namespace vernier::workbench {

/// Returns every name that an expression of this machine may use, with its unit and its meaning, for
/// completion: [{name, unit, what}]. `candidates`: columns that the machine file does not use yet; `add`
/// declares these columns.
nlohmann::ordered_json expression_names(const model::Machine& machine);

/// Tests whether `text` is a term for a degree of freedom whose unit is `unit` (mm or deg). The unknown
/// coefficient is `k`. Returns {"ok", "message", "offset", "word"} if `text` is not an expression of this
/// machine; else {"ok": true, "unit" of the expression without k, "k_unit": required unit of k, "warnings":
/// units that do not match}. Units never scale a value (FORMATS section 1) and only cause warnings.
nlohmann::ordered_json check_term(const model::Machine& machine, const std::string& text,
                                  const std::string& unit);

}  // namespace vernier::workbench
