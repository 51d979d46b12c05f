// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/diagnose/findings.h"
#include "tools/diagnose/types.h"

namespace vernier::diagnose {

/// Sets the verdict, its explanation and its details in `answer`: `left`, `remaining`, `time_base`,
/// `instrument`, `runner_up`, aliases and confusions of candidates. The first rule that applies determines
/// the verdict. A table in the source file gives the order of the rules. `answer` must already contain the
/// members `base` and `end`, the stepwise model and the candidates.
void set_verdict(const Findings& found, Diagnosis& answer);

}  // namespace vernier::diagnose
