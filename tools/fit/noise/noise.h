// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/fit/noise/noise_layout.h"

namespace vernier::fit {

/// A step of the instrument: from this row on, all readings of one kind have the same additional error. If
/// the measured object was set up again, the additional error is one component of a shift, projected on the
/// normal of each reading.
struct NoiseStep {
  int kind = 0;
  std::size_t row = 0;
  double height = 0, std = 0;  // in weighted readings (readings / u)
  int component = -1;          // 0, 1, 2: component of the shift along the normal; -1: no set-up
  double unit = 0;             // um or arcsec of a weighted reading at the row of the step; 0: not known
  bool of_set_up() const { return component >= 0; }
  bool operator==(const NoiseStep& other) const {
    return kind == other.kind && row == other.row && component == other.component;
  }
};

/// Noise model of the readings: the correlation of their errors. The noise model has four components:
/// independent noise (`own`), per-pose noise (`pose`), per-run or set-up noise (`run`), and a drift in time
/// (`drift`). The drift is an Ornstein-Uhlenbeck process. If its time constant is much longer than the
/// record, the drift is a random walk. The components are standard deviations in units of u, or in mm and deg
/// if no u is given.
struct NoiseModel {
  double own = 1, pose = 0, run = 0, drift = 0;
  double time_constant = 0;   // time constant of the drift, s or rows
  std::uint32_t drifts = 0;   // kinds of reading that drift: bit n is kind n; 0: all kinds
  bool in_time = false;       // true: the unit of the time constant is s; false: rows, even if the times are
                              // recorded
  double support = 0;         // decrease of -2 log likelihood (restricted), compared with independent
                              // readings
  double log_likelihood = 0;  // logarithm of the restricted likelihood
  std::vector<NoiseStep> steps;  // steps of the instrument, fitted as deterministic errors

  bool independent() const { return pose <= 0 && run <= 0 && drift <= 0 && steps.empty(); }
  /// Returns the standard deviation of all noise components except the independent noise.
  double shared() const;
  double total() const;
  /// Returns the penalty of the noise model in a selection criterion (BIC), in units of the logarithm of the
  /// number of readings. Each parameter of the noise model adds 1 to the penalty. A step of the instrument
  /// adds 1 to the penalty for its height in each kind of reading, and kPriceOfPlace for its row.
  double price() const;
};

/// Returns the design-matrix columns of the steps, one entry per reading: 0 before the step; from the step on
/// 1, or the component of the normal for a set-up.
Eigen::MatrixXd step_columns(const NoiseLayout& layout, const std::vector<NoiseStep>& steps,
                             Eigen::Index readings);

/// Returns steps of the noise model for shifts of the measured object. Each set-up has three steps at its
/// first row, one for each component of the shift. The height of each step is 0, because set_up_steps does
/// not estimate the shift. The result of set_up_steps() is empty if there is only one set-up, or no reading
/// along a normal.
std::vector<NoiseStep> set_up_steps(const NoiseLayout& layout);

/// Whitens the rows of `columns` (weighted readings): the result has independent rows with variance 1. The
/// method is a Kalman filter along each series. The computing time is proportional to the number of rows
/// times the number of columns. The function returns the logarithm of the determinant of the covariance.
double whiten(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns);

/// Multiplies `columns` by the transpose of the matrix of whiten().
void whiten_transposed(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns);

/// Returns the product of the covariance of the weighted readings and `columns`. The computing time is
/// proportional to the number of rows times the number of columns.
Eigen::MatrixXd covariance_times(const NoiseLayout& layout, const NoiseModel& model,
                                 const Eigen::MatrixXd& columns);

/// Unit of a weighted reading: the rms of u, separately for lengths and for rotations; 1 mm and 1 deg if no u
/// is given.
struct NoiseUnit {
  double um = 1000, arcsec = 3600;
  bool angles_only = false;  // true: the measurement has no length readings

  /// Returns the unit of a weighted reading: of rotations if `rotation` is true, otherwise of lengths.
  double of(bool rotation) const { return rotation ? arcsec : um; }
  /// Returns the unit of the noise components that all kinds of readings have in common: the unit of lengths,
  /// or the unit of angles if there are no lengths.
  double of_all() const { return of(angles_only); }
};
constexpr const char* unit_name(bool rotation) { return rotation ? "arcsec" : "um"; }

/// Returns the names of the kinds of reading that drift; empty if all kinds drift or no kind drifts.
std::vector<std::string> drifting_kinds(const NoiseModel& model);

/// Describes a step that is not a set-up, for example "22.8 +- 0.12 um in x": its height with the standard
/// deviation, and the kind of reading.
std::string step_in_words(const NoiseStep& step, const NoiseUnit& unit);

/// Describes a noise model in one sentence for people.
std::string in_words(const NoiseModel& model, const NoiseUnit& unit);

}  // namespace vernier::fit
