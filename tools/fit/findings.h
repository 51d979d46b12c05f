// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/types.h"
#include "tools/model/fit_record.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// What the model lacks, as far as the residual shows it: for each direction of workpiece coordinates the
/// root of the mean squared residual beyond the noise (stated u; without u repeats), mm; of fit rows
/// (corrected for what the fit took up) and of check rows, whichever is larger. A direction counts where
/// chance explains it one time in a thousand at most, and one that no reading looks along gets the mean of
/// the others. Readings along a direction are those whose own direction is nearest to it. Zero where the
/// noise is not known. tool.
Eigen::Vector3d model_discrepancy(const FitResult& result, const model::Measurement& measurement);

/// What every later command repeats. Codes: `something-missing` (value: residual over noise), `noise-unknown`
/// (the readings have neither u nor repeats), `no-gain` (check rows against the nominal machine), `disturbed`
/// (share of what the nominal machine leaves), `check-not-independent` (share of the check rows at poses of
/// fit rows), `not-varied` (number of dependences), `not-distinguished` (number of alternatives), `absurd`,
/// `not-converged`. record: with everything else in it. tool.
std::vector<model::FitRecord::Finding> findings_of(const FitResult& result, const model::FitRecord& record,
                                                   const model::Measurement& measurement);

}  // namespace vernier::fit
