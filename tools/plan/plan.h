// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Finds the rows that should be measured next to distinguish two named effects. `a`, `b`: ids of effects or
/// add strings (see fit_hypothesis). The object `effects` must exist longer than the plan. Throws InputError
/// if an effect is unknown or has no candidate in the rows.
Plan plan_next(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
               const std::string& a, const std::string& b, const std::vector<effects::Effect>& effects,
               const PlanOptions& options = {});

/// Returns advice for the list `next_measurement` of a diagnosis: the sentence of the plan, and the
/// requirements of the plan. The list is empty if the plan has no advice for the two effects.
std::vector<std::string> next_measurement(const std::string& text, const model::Machine& machine,
                                          const model::Measurement& measurement, const std::string& a,
                                          const std::string& b, const std::vector<effects::Effect>& effects,
                                          const PlanOptions& options = {});

}  // namespace vernier::plan
