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
/// the measured object was set up again, the error is one component of a shift along the normal of each
/// reading.
struct NoiseStep {
  int kind = 0;
  std::size_t row = 0;
  double height = 0, std = 0;  // weighted readings
  int component = -1;          // 0 1 2: of the normal
  bool of_set_up() const { return component >= 0; }
  bool operator==(const NoiseStep& other) const {
    return kind == other.kind && row == other.row && component == other.component;
  }
};

/// Correlation of the errors of readings. Components: independent noise, per-pose noise, per-run (set-up)
/// noise (`run`), and a drift in time. The drift is an Ornstein-Uhlenbeck process; a random walk if its time
/// constant is much longer than the record. Standard deviations in units of u, or in mm and deg if no u is
/// given.
struct NoiseModel {
  double own = 1, pose = 0, run = 0, drift = 0;
  double time_constant = 0;   // of the drift, s or rows
  std::uint32_t drifts = 0;   // kinds of reading that drift: bit n is kind n; 0: all
  bool in_time = false;       // else it counts rows, even if time is recorded
  double support = 0;         // decrease of -2 log likelihood (restricted) relative to independent readings
  double log_likelihood = 0;  // restricted
  std::vector<NoiseStep> steps;  // of the instrument: fitted, deterministic

  bool independent() const { return pose <= 0 && run <= 0 && drift <= 0 && steps.empty(); }
  /// Returns the standard deviation of all components except the independent noise.
  double shared() const;
  double total() const;
  /// Returns the penalty of the noise model in a selection criterion, in units of the logarithm of the number
  /// of readings. A parameter counts 1. A step counts 1 for its height in each kind of reading, and
  /// `of_place` for its row.
  double price(double of_place = NoiseThresholds().price_of_place) const;
};

/// Returns the columns of the steps, one entry per reading: 0 before the step, 1 from the step on.
Eigen::MatrixXd step_columns(const NoiseLayout& layout, const std::vector<NoiseStep>& steps,
                             Eigen::Index readings);

/// Returns steps of the noise model for shifts of the measured object: three steps at the first row of each
/// set-up, one for each component of the shift. The height of each step is 0: the shift is not estimated
/// here. The result is empty if there is only one set-up or no reading along a normal.
std::vector<NoiseStep> set_up_steps(const NoiseLayout& layout);

/// Transforms the rows of `columns` (weighted readings) to independent rows with variance 1, by a
/// Kalman filter along each series. The computing time grows with rows times columns. Returns log
/// det of the covariance.
double whiten(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns);

/// Returns the covariance of the weighted readings times `columns`. Computing time: rows times
/// columns.
Eigen::MatrixXd covariance_times(const NoiseLayout& layout, const NoiseModel& model,
                                 const Eigen::MatrixXd& columns);

/// Unit of a weighted reading: rms of u of lengths and of rotations; 1 mm and 1 deg if no u is
/// given.
struct NoiseUnit {
  double um = 1000, arcsec = 3600;
  bool angles_only = false;  // no length was measured

  /// Returns the unit of a reading of that kind.
  double of(bool rotation) const { return rotation ? arcsec : um; }
  /// Returns the unit of the components that all kinds share: that of lengths; that of angles if there are no
  /// lengths.
  double of_all() const { return of(angles_only); }
};
constexpr const char* unit_name(bool rotation) { return rotation ? "arcsec" : "um"; }

/// Names of the kinds of reading that drift; empty if all kinds or none drift.
std::vector<std::string> drifting_kinds(const NoiseModel& model);

/// Describes a noise model in one sentence for people.
std::string in_words(const NoiseModel& model, const NoiseUnit& unit);

}  // namespace vernier::fit
