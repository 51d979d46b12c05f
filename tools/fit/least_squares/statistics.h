// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/noise/noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Unweighted statistics of the observations of one role, lengths in um, rotations in urad. nullopt if there
/// are no observations.
struct RoleStatistics {
  std::optional<double> rms_um, max_um, rms_urad, max_urad;
  std::size_t count = 0;  // lengths and rotations
};

/// Returns residual = measured - predicted, one per observation, mm or deg.
Eigen::VectorXd residuals(const model::Machine& machine, const model::Measurement& measurement);

/// residual: measured - model, one per observation of `m`, mm or deg. `check`: the role of the
/// observations.
RoleStatistics role_statistics(const model::Measurement& m, const Eigen::VectorXd& residual, bool check);

/// Returns all values of a row that were set or logged, except time and the measured values. Rows with the
/// same conditions are repeats. The correction of a board is not included: a reading contains it, a residual
/// does not.
std::vector<double> row_conditions(const model::Measurement& m, std::size_t row);

/// Returns the noise of the measurement, um: rms of u over the fit rows' lengths. If the rows have no
/// standard uncertainty u, the noise is estimated from repeats: rows with the same axes, corrections, motion,
/// inputs and candidates in any run (pooled standard deviation, at least 5 degrees of freedom). If the rows
/// have neither a standard uncertainty u nor repeats, the result is nullopt.
std::optional<double> noise_um(const model::Measurement& m);
/// The same for the rotations, urad.
std::optional<double> noise_urad(const model::Measurement& m);

/// Returns the length and the angle that a weighted reading of 1 represents: the rms of u over the fit rows,
/// or 1 mm and 1 deg without u.
NoiseUnit noise_unit(const model::Measurement& m);

/// Returns the weight of each observation in a fit: 1/u, 1 if u is absent, 0 for check rows. The weight
/// multiplies the residual.
Eigen::VectorXd fit_weights(const model::Measurement& m);

/// Returns the indices of the readings of the fit rows: their weight is not zero.
std::vector<std::size_t> fitted_readings(const Eigen::VectorXd& weights);

/// True if u is given for every fit row.
bool has_uncertainty(const model::Measurement& m);

}  // namespace vernier::fit
