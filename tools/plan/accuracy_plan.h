// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// From existing measurements: the covariance and the noise of the fit. The next readings are in the set-up
/// of the plain BaseShift if the file has a free one, else in a new set-up. Throws InputError if the
/// measurement has no x, y or z. tool.
Knowledge knowledge_of(const fit::FitResult& fitted, const model::Measurement& measurement);
/// From the machine file alone, with a new set-up. Throws InputError if it was never fitted. tool.
Knowledge knowledge_of(const model::Machine& fitted);

/// Selects the next poses one by one. Each lowers most the mean square of the tool point's
/// uncertainty over the aim, beside a set-up that may be new (I-optimal; Wu, Klimchik, Caro, Furet
/// and Pashkevich 2013 for a test pose), until U95 reaches the requested value. A rigid motion of
/// the whole (of a part: the motion that its datums determine) is ignored. Throws InputError: an
/// axis without range, no free parameters. tool.
AccuracyPlan accuracy_plan(const Knowledge& knowledge, const AccuracyAim& aim,
                           const AccuracyOptions& options);

/// Returns U95 over the aim after readings at any poses, um, by the same definition. tool.
double expected_accuracy_um(const Knowledge& knowledge, const AccuracyAim& aim, const model::States& poses);

/// Returns a measurement file with these rows. The readings must be filled in.
std::string accuracy_plan_csv(const Knowledge& knowledge, const AccuracyPlan& plan);

/// Label of the planned rows.
inline constexpr const char* kAccuracyRun = "accuracy";

}  // namespace vernier::plan
