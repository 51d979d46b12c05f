// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Derives p(actual) - p(nominal) in factored form along the chain. The deviation is expressed along the
/// linear axes if they span it, otherwise along the rotary axes too. neglect_mm: a higher-order term smaller
/// than this over the declared ranges is omitted and entered in `neglected`. evaluations: each further
/// evaluation repeats the deviation with the correction so far, p(actual, corrected) - p(nominal). A further
/// evaluation also corrects the remainder: it is a step of Newton's iteration with the nominal Jacobian. If
/// the machine corrects orientation, the rotary axes first correct the direction. The linear axes then
/// correct the point, including the influence of the rotary axes. Throws InputError in one line if the
/// machine cannot be compiled: a free static without nominal, an axis without range, an axis whose direction
/// of nominal motion changes in a step, an expression with an operation that the program does not support.
Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations = 1);

}  // namespace vernier::compile
