// SPDX-License-Identifier: GPL-3.0-or-later
// Readings that describe the machine in another way than the machine file: other rows, other zeros of joints;
// and of other instruments.
#pragma once
#include <string>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::commands {

/// Returns a sentence if the readings belong to the row before or after their own: the residual of the given
/// machine with a fitted set-up falls to a fifth if all readings move by one row. Only for points and
/// rotations; otherwise empty.
std::string readings_of_other_rows(const model::Machine& machine, const model::Measurement& m);

/// Returns a sentence if an angle of the fit is about a quarter turn or a half turn from nominal: another
/// zero or another direction of a joint in the readings, which is no error. The sentence names the joint if
/// the fit of the readings with this joint changed leaves as little. Empty without such an angle.
std::string other_zero_of_joint(const model::Machine& machine, const model::Measurement& m,
                                const fit::FitResult& result);

/// Returns a sentence if files have readings of different forms (points, distances, touches) and no reading
/// has a standard uncertainty: instruments of different noise then have the same weight. Otherwise empty.
std::string readings_of_one_weight(const model::Measurement& m);

}  // namespace vernier::commands
