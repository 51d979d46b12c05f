// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Returns the knowledge from existing measurements: the covariance and the noise of the fit. The next
/// readings belong to the set-up of the BaseShift without `run` and `setup`, if this BaseShift exists and is
/// a free parameter of the fit. Otherwise the next readings belong to a new set-up. Throws InputError if the
/// measurement has no x, y or z.
Knowledge knowledge_of(const fit::FitResult& fitted, const model::Measurement& measurement);
/// Returns the knowledge from the machine file alone, with a new set-up. Throws InputError if the machine was
/// never fitted.
Knowledge knowledge_of(const model::Machine& fitted);

/// Chooses the next poses one by one until the required U95 is reached. Each pose lowers most the mean square
/// of the tool point's uncertainty over the aim, with a set-up that may be new (I-optimal; Wu, Klimchik,
/// Caro, Furet and Pashkevich 2013 for a test pose). A rigid motion of the whole machine (for a part: the
/// motion that its datums absorb) does not count. Throws InputError: an axis without range, no free
/// parameter.
AccuracyPlan accuracy_plan(const Knowledge& knowledge, const AccuracyAim& aim,
                           const AccuracyOptions& options);

/// Returns U95 over the aim after readings at any poses, um, computed as in accuracy_plan.
double expected_accuracy_um(const Knowledge& knowledge, const AccuracyAim& aim, const model::States& poses);

/// Returns a measurement file with the rows of the plan; the readings must be filled in.
std::string accuracy_plan_csv(const Knowledge& knowledge, const AccuracyPlan& plan);

/// Label of the planned rows.
inline constexpr const char* kAccuracyRun = "accuracy";

}  // namespace vernier::plan
