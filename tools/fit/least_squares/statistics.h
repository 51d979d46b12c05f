// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/noise/noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Unweighted statistics of the observations of one role (fit or check): lengths in um, rotations in urad. A
/// value is nullopt if there are no observations of its kind.
struct RoleStatistics {
  std::optional<double> rms_um, max_um, rms_urad, max_urad;
  std::size_t count = 0;  // number of observations, lengths and rotations together
};

/// Returns the residual (measured - predicted) of each observation, mm or deg.
Eigen::VectorXd residuals(const model::Machine& machine, const model::Measurement& measurement);

/// `residual`: measured - model of each observation of `m`, mm or deg. `check`: true selects the check rows;
/// false selects the fit rows.
RoleStatistics role_statistics(const model::Measurement& m, const Eigen::VectorXd& residual, bool check);

/// Returns all values of a row that were set or logged, except time and the measured values. The result also
/// has the set-up of the instrument, the direction of the reading, and the pose at the other end of a
/// distance. Rows with equal conditions are repeats of one measurement. The conditions do not include the
/// correction of a board, because a residual does not contain this correction.
std::vector<double> row_conditions(const model::Measurement& m, std::size_t row);

/// Returns the noise of the length readings, um: the rms of the standard uncertainty u over the fit rows. If
/// the rows have no u, the noise is estimated from repeats (pooled standard deviation, at least 5 degrees of
/// freedom). Repeats are rows with the same axes, corrections, motion, inputs and candidates in any run. The
/// noise is nullopt if the rows have neither a standard uncertainty u nor repeats.
std::optional<double> noise_um(const model::Measurement& m);
/// Returns the noise of the rotation readings, urad. The method is that of noise_um().
std::optional<double> noise_urad(const model::Measurement& m);

/// Pooled standard deviation of repeats, and its degrees of freedom.
struct RepeatNoise {
  double value = 0;  // um; urad of rotations
  std::size_t freedom = 0;
};
/// Returns the noise of the length or rotation readings from repeats alone, as noise_um() and noise_urad() do
/// for rows without u. nullopt: the repeats have less than 5 degrees of freedom.
std::optional<RepeatNoise> noise_of_repeats(const model::Measurement& m, bool rotations);

/// Returns the same noise from rows that are repeated in other set-ups, beside a mean of each repeated row
/// and an offset of each set-up (in each kind of reading), because a new alignment changes the offset. Other
/// changes between the set-ups increase the result. nullopt: less than 5 degrees of freedom.
std::optional<RepeatNoise> noise_of_repeats_in_set_ups(const model::Measurement& m, bool rotations);

/// Returns the length and the angle that a weighted reading of 1 represents: the rms of u over the fit rows,
/// or 1 mm and 1 deg if u is absent.
NoiseUnit noise_unit(const model::Measurement& m);

/// Returns the weight of each observation in a fit: 1/u; 1 if u is absent; 0 for check rows. The fit
/// multiplies the residual of an observation by this weight.
Eigen::VectorXd fit_weights(const model::Measurement& m);

/// Returns the indices of the readings of the fit rows, whose weight is not zero.
std::vector<std::size_t> fitted_readings(const Eigen::VectorXd& weights);

/// True if every fit row has a standard uncertainty u.
bool has_uncertainty(const model::Measurement& m);

}  // namespace vernier::fit
