// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Derives p(actual) - p(nominal) in factored form along the chain, seen along the linear axes where they
/// span it, else along the rotary ones too. neglect_mm: a higher-order term smaller than this over the
/// declared ranges is left out and entered in `neglected`. evaluations: beyond the first, the deviation is
/// evaluated again with the correction so far, p(actual, corrected) - p(nominal), and what is left of it
/// corrected too: a step of Newton's iteration with the nominal Jacobian. Of a machine that corrects
/// orientation the rotary axes put the direction right first, the linear ones the point, with what the rotary
/// ones do. Throws InputError in one line where the machine cannot be compiled: a free static without
/// nominal, an axis without range, an axis whose nominal motion has a step, an expression that the program
/// has no operation for. tool.
Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations = 1);

}  // namespace vernier::compile
