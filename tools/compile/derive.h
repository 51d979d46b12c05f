// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Derives p(actual) - p(nominal) in factored form along the chain. It is expressed along the
/// linear axes if they span it, otherwise along the rotary ones too. neglect_mm: a higher-order
/// term smaller than this over the declared ranges is omitted and entered in `neglected`.
/// evaluations: beyond the first, the deviation is evaluated again with the correction so far,
/// p(actual, corrected) - p(nominal). Its remainder is corrected too: a step of Newton's iteration
/// with the nominal Jacobian. If the machine corrects orientation, the rotary axes first correct
/// the direction. The linear axes then correct the point, including the influence of the rotary
/// ones. Throws InputError in one line if the machine cannot be compiled: a free static without
/// nominal, an axis without range, an axis whose nominal motion has a step, an expression without
/// an operation of the program. tool.
Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations = 1);

}  // namespace vernier::compile
