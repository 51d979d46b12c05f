// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::fit {

/// Readings of one kind in the order of the file: what an error that hangs together in time, run or pose is
/// shared along.
struct NoiseSeries {
  std::vector<Eigen::Index> reading;  // positions in the list that the layout was made for
  std::vector<double> time;  // s, or rows where no time tells them apart; never falling within a clock
  int kind = 0;              // of ObservationKind
  std::vector<std::size_t> row;
  std::vector<int> setup, clock, pose;  // an index each; a pose: rows that follow one another at one place
  std::vector<Eigen::Vector3d> normal;  // of readings along one
};

/// The readings of a list of observations, as a noise model sees them.
struct NoiseLayout {
  std::vector<NoiseSeries> series;
  bool in_time = false;       // time is s, else rows
  bool has_runs = false;      // more than one
  bool has_poses = false;     // some pose was read more than once in a row
  double step = 1, span = 1;  // median step from row to row, longest run, in the unit of time
  double row_span = 1;        // longest run, rows
};

/// observations: indices into measurement.observations, in their order. Positions count as one pose where
/// they differ by less than a tolerance that the gap between small and large steps gives. tool.
NoiseLayout noise_layout(const model::Measurement& measurement, const std::vector<std::size_t>& observations);

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

/// How the errors of readings hang together: each reading's own, one that the readings of a pose share, one
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
  /// step its height in each kind of reading, and its place among all rows.
  double price() const;
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

/// Readings times the square of what was fitted, beyond which a look at the likelihood takes what was fitted
/// by its number alone.
inline constexpr double kMostNoiseProducts = 6e7;

/// Restricted maximum likelihood (Patterson and Thompson 1971) of a residual beside what was fitted.
/// residual: weighted, held at 4 robust spreads first; fitted: orthonormal columns that were fitted to it. A
/// component enters where the likelihood falls by more than chance would make it. `with_u`: all parts
/// together are not below 1. tool.
NoiseModel estimate_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& fitted, bool with_u);

/// One sentence for people. unit_um: um that 1 stands for (rms of u; 1000 where none is given). tool.
std::string in_words(const NoiseModel& model, double unit_um);

}  // namespace vernier::fit
