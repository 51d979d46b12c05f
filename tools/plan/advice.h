// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/catalogue.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// What to measure next where the first candidate of an ambiguous diagnosis and one that it is confounded
/// with explain the rows alike; empty where nothing is to be told apart. text: the machine file's. tool.
std::vector<std::string> advice_for(const std::string& text, const model::Machine& machine,
                                    const model::Measurement& measurement,
                                    const diagnose::Diagnosis& diagnosis,
                                    const std::vector<effects::Effect>& effects);

}  // namespace vernier::plan
