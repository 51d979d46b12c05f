// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/plan/rival.h"

namespace vernier::plan {

/// Finds other causes that explain the rows nearly as well as the best candidate of all. A diagnosis also
/// compares these causes: rows that separate two named effects should separate these causes too. The result
/// has one cause per effect, driving axis and input, best first, at most `most`. The named effects are not
/// included.
std::vector<FittedRival> find_bystanders(const effects::MachineText& model,
                                         const model::Measurement& measurement,
                                         const std::vector<const FittedRival*>& named,
                                         const std::vector<effects::Effect>& effects, std::size_t most);

}  // namespace vernier::plan
