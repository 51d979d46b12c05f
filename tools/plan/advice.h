// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/catalogue.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns advice for the next measurement. The advice is for an ambiguous diagnosis, in which the first
/// candidate and an alternative explain the rows equally well. The advice is empty if there are no effects to
/// distinguish. `text`: the text of the machine file.
std::vector<std::string> advice_for(const std::string& text, const model::Machine& machine,
                                    const model::Measurement& measurement,
                                    const diagnose::Diagnosis& diagnosis,
                                    const std::vector<effects::Effect>& effects);

}  // namespace vernier::plan
