// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::vibration {

/// A quantity over the clock of its instrument: t in s, increasing, and the same number of values.
struct Series {
  std::vector<double> t_s, value;
};

/// Relation between the clocks of two instruments: t_reference = offset + rate * t_other.
struct ClockFit {
  double offset_s = 0, rate = 1;
  double offset_std_s = 0, rate_std = 0;  // offset at the middle of the overlap; from the residual
  double correlation = 0;  // of the two series in their overlap, after the alignment of the clocks
  double second_best =
      0;  // next best correlation at another lag: if it is close to the first, the result is ambiguous
};

/// Finds offset and rate between the clocks of two records of one motion (encoder and accelerometer, both as
/// accelerations; encoder and ball bar, both as lengths). The cross-correlation of the resampled records
/// gives the lag. Least squares then give offset, rate, gain and mean in windows that grow from the middle to
/// the whole overlap. A rate error of 1e-3 is therefore found. Throws InputError: records shorter than 16
/// samples, times that do not increase, no common motion (correlation below 0.5).
ClockFit align_clocks(const Series& reference, const Series& other);

/// Position on a sampled path: between samples `sample` and `sample` + 1, at the share `fraction`
/// 0..1, at the distance `distance` from the path.
struct PathPlace {
  std::size_t sample = 0;
  double fraction = 0, distance = 0;
};

/// Returns for each point (a column) the nearest position on the path (columns in order of time), for records
/// without a common clock. Points are in the order of the motion. The search starts at the position of the
/// previous point and ends at most `reach` of the path's length further (mm). A second pass over the same
/// positions is therefore not confused with the first pass. The first point is searched on the first `reach`.
/// Throws InputError for a path of less than two samples.
std::vector<PathPlace> nearest_places(const Eigen::MatrixXd& path, const Eigen::MatrixXd& points,
                                      double reach);

}  // namespace vernier::vibration
