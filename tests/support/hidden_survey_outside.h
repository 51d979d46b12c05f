// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tests/support/hidden_survey_forms.h"

namespace vernier::support {

/// A form that is in no catalogue and beyond a product of three factors.
Form outside_form(const Geometry& geometry, const std::vector<LoggedColumn>& columns, Draw& draw);

}  // namespace vernier::support
