// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/support/hidden_survey.h"

namespace vernier::support {

const char* class_name(SurveyClass kind);
SurveyClass class_named(const std::string& name);

/// The effects that surveys of a family can hide.
std::vector<std::string> effects_of(Family family);

/// The key of a survey as JSON: what is hidden, and what else may be answered.
std::string key_of(const HiddenSurvey& survey);

}  // namespace vernier::support
