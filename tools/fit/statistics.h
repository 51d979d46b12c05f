// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Unweighted figures over one role's observations, lengths in um, rotations in urad. Nothing where there are
/// none.
struct RoleStatistics {
  std::optional<double> rms_um, max_um, rms_urad, max_urad;
  std::size_t count = 0;  // lengths and rotations
};

/// residual = measured - predicted, one per observation, mm or deg.
Eigen::VectorXd residuals(const model::Machine& machine, const model::Measurement& measurement);

/// residual: measured - model, one per observation of `m`, mm or deg. `check`: which role to look at.
RoleStatistics role_statistics(const model::Measurement& m, const Eigen::VectorXd& residual, bool check);

/// All that was set or logged in a row besides time and the measured values: rows with the same numbers are
/// repeats. What a board added is not in it: a residual is beside it, a reading is not. tool.
std::vector<double> row_conditions(const model::Measurement& m, std::size_t row);

/// Noise of the measurement, um: rms of u over the fit rows' lengths; without u from repeats (rows with the
/// same axes, corrections, motion, inputs and candidates in the same run or another, pooled standard
/// deviation, at least 5 degrees of freedom); else nothing.
std::optional<double> noise_um(const model::Measurement& m);

/// What 1 of a weighted reading stands for.
NoiseUnit noise_unit(const model::Measurement& m);

/// Weight of each observation in a fit: 1/u, 1 where u is absent, 0 for check rows. Multiplies the residual.
Eigen::VectorXd fit_weights(const model::Measurement& m);

/// Is u given for every fit row?
bool has_uncertainty(const model::Measurement& m);

}  // namespace vernier::fit
