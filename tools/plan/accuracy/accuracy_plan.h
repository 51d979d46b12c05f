// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Returns the knowledge of a machine from existing measurements: the covariance and the noise of the fit.
/// The next readings belong to the set-up of the BaseShift without `run` and `setup`, if the fit has such a
/// BaseShift as a free parameter. If the fit has no BaseShift without `run` and `setup`, the next readings
/// belong to a new set-up. Throws InputError if the measurement has no reading x, y or z.
Knowledge knowledge_of(const fit::FitResult& fitted, const model::Measurement& measurement);
/// Returns the knowledge of a machine from the machine file alone, with a new set-up for the next readings.
/// Throws InputError if the machine was never fitted.
Knowledge knowledge_of(const model::Machine& fitted);

/// Selects the next poses, one after another, until the required U95 is reached. Each selected pose is the
/// one that most reduces the mean square uncertainty of the tool point over the aim (I-optimal; Wu, Klimchik,
/// Caro, Furet and Pashkevich 2013 for a test pose). The set-up of the readings may be new. A rigid motion of
/// the whole machine does not count. For a part, a motion that the alignment to its datums removes does not
/// count. Throws InputError if an axis has no range or if no parameter is free.
AccuracyPlan accuracy_plan(const Knowledge& knowledge, const AccuracyAim& aim,
                           const AccuracyOptions& options);

/// Returns U95 over the aim, um, after readings at the given poses. U95 after the readings is computed as in
/// accuracy_plan.
double expected_accuracy_um(const Knowledge& knowledge, const AccuracyAim& aim, const model::States& poses);

/// Returns a measurement file with the rows of the plan, in which the user enters the readings.
std::string accuracy_plan_csv(const Knowledge& knowledge, const AccuracyPlan& plan);

/// Run label of the planned rows.
inline constexpr const char* kAccuracyRun = "accuracy";

}  // namespace vernier::plan
