// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Finds the rows to measure next that distinguish two named effects. `a`, `b`: ids or add strings (see
/// fit_rival). The effects must outlive the plan. Throws InputError.
Plan plan_next(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
               const std::string& a, const std::string& b, const std::vector<effects::Effect>& effects,
               const PlanOptions& options = {});

/// Returns the sentence of the plan and the requirements of the plan, for the list of a diagnosis. The list
/// is empty if the plan has no advice for the pair.
std::vector<std::string> next_measurement(const std::string& text, const model::Machine& machine,
                                          const model::Measurement& measurement, const std::string& a,
                                          const std::string& b, const std::vector<effects::Effect>& effects,
                                          const PlanOptions& options = {});

}  // namespace vernier::plan
