// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::vibration {

/// One quantity over the clock of its instrument: t in s, increasing; as many values.
struct Series {
  std::vector<double> t_s, value;
};

/// How the clock of one instrument follows from another's: t_reference = offset + rate * t_other.
struct ClockFit {
  double offset_s = 0, rate = 1;
  double offset_std_s = 0, rate_std = 0;  // offset at the middle of the overlap; from the residual
  double correlation = 0;                 // of the two series where they overlap, clocks brought together
  double rival = 0;  // next best correlation at another lag: close to the first, it is ambiguous
};

/// Finds offset and rate of two records of one motion (encoder and accelerometer, both as accelerations;
/// encoder and ball bar, both as lengths): the lag by cross-correlation of the resampled records, then
/// offset, rate, gain and mean by least squares in windows that grow from the middle to the whole overlap, so
/// that a rate of 1e-3 off is followed. Throws InputError: records shorter than 16 samples, times that do not
/// increase, no common motion (correlation below 0.5). tool.
ClockFit align_clocks(const Series& reference, const Series& other);

/// Place on a sampled path: between samples `sample` and `sample` + 1, `fraction` 0..1 of the way, `distance`
/// off.
struct PathPlace {
  std::size_t sample = 0;
  double fraction = 0, distance = 0;
};

/// For each point (a column) the nearest place on the path (columns in order of time), for records without a
/// common clock. Points are in the order of the motion: the search goes from the place of the last one at
/// most `reach` of the path's length forward (mm), so that a second pass over the same positions is not taken
/// for the first; the first point is sought on the first `reach`. Throws InputError for a path of less than
/// two samples. tool.
std::vector<PathPlace> nearest_places(const Eigen::MatrixXd& path, const Eigen::MatrixXd& points,
                                      double reach);

}  // namespace vernier::vibration
