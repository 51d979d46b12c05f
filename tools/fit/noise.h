// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/fit/noise_layout.h"

namespace vernier::fit {

/// From this row on all readings of one kind are off by the same; or, where what is touched was set up anew,
/// by that component of a shift along each reading's normal.
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

/// How the errors of readings are correlated: each reading's own, one that the readings of a pose share, one
/// that a set-up shares (`run`), and one that wanders with the clock (Ornstein-Uhlenbeck; a random walk where
/// the time constant is far beyond its stretch). Standard deviations in units of u, in mm and deg where no u
/// is given.
struct NoiseModel {
  double own = 1, pose = 0, run = 0, drift = 0;
  double time_constant = 0;      // of the drift, s or rows
  bool in_time = false;          // else it counts rows, whatever time there is
  double support = 0;            // fall of -2 log likelihood (restricted) against independent readings
  double log_likelihood = 0;     // restricted
  std::vector<NoiseStep> steps;  // of the instrument: fitted, not random

  bool independent() const { return pose <= 0 && run <= 0 && drift <= 0 && steps.empty(); }
  /// Standard deviation of what is not a reading's own.
  double shared() const;
  double total() const;
  /// What it costs in a criterion of selection, in units of the logarithm of the readings: a parameter 1, a
  /// step its height in each kind of reading, and its place among all rows, which costs `of_place`.
  double price(double of_place = NoiseThresholds().price_of_place) const;
};

/// Columns of the steps, an entry a reading: 1 from the step on. tool.
Eigen::MatrixXd step_columns(const NoiseLayout& layout, const std::vector<NoiseStep>& steps,
                             Eigen::Index readings);

/// A shift of what is touched at each set-up, three components each; none where there is but one set-up or no
/// reading along a normal. Heights are 0.
std::vector<NoiseStep> set_up_steps(const NoiseLayout& layout);

/// Rows of `columns` (weighted readings) made independent with variance 1, by a Kalman filter along each
/// series; its cost grows with rows times columns. Returns log det of the covariance. tool.
double whiten(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns);

/// Covariance of the weighted readings times `columns`. Cost: rows times columns. tool.
Eigen::MatrixXd covariance_times(const NoiseLayout& layout, const NoiseModel& model,
                                 const Eigen::MatrixXd& columns);

/// What 1 of a weighted reading stands for: rms of u of lengths and of rotations; 1 mm and 1 deg where none
/// is given.
struct NoiseUnit {
  double um = 1000, arcsec = 3600;
  bool angles_only = false;  // no length was read

  /// Of a reading of that kind.
  double of(bool rotation) const { return rotation ? arcsec : um; }
  /// Of the parts that all kinds share: of lengths, unless there are none.
  double of_all() const { return of(angles_only); }
};
constexpr const char* unit_name(bool rotation) { return rotation ? "arcsec" : "um"; }

/// One sentence for people. tool.
std::string in_words(const NoiseModel& model, const NoiseUnit& unit);

}  // namespace vernier::fit
