// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Derives the error equation of a machine: the difference p(actual) - p(nominal) in factored form along the
/// chain. The deviation is expressed as motions of the linear axes if they reach all its directions;
/// otherwise the rotary axes are used too. `neglect_mm`: a higher-order term that is smaller than this limit
/// over the declared ranges is omitted and listed in `neglected`. `evaluations`: number of evaluations of the
/// deviation. Each further evaluation computes the deviation with the correction so far, p(actual, corrected)
/// - p(nominal). A further evaluation corrects the remaining deviation. the further evaluation is a step of
///   Newton's iteration
/// with the nominal Jacobian. If the machine corrects the orientation, the rotary axes first correct the
/// direction of the tool. After the correction of the direction, the linear axes correct the tool point,
/// including the influence of the rotary axes. Throws InputError with one line if the machine cannot be
/// compiled. Causes are a free static without nominal, an axis without range, an axis whose nominal direction
/// of motion changes in a step, or an operation that the program does not support.
Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations = 1);

}  // namespace vernier::compile
