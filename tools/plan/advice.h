// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/catalogue.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns advice for the next measurement if the first candidate of an ambiguous diagnosis and an
/// alternative explain the rows equally well. Empty if no effects need to be distinguished. text: the text of
/// the machine file.
std::vector<std::string> advice_for(const std::string& text, const model::Machine& machine,
                                    const model::Measurement& measurement,
                                    const diagnose::Diagnosis& diagnosis,
                                    const std::vector<effects::Effect>& effects);

}  // namespace vernier::plan
