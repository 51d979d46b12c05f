// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::vibration {

/// Series of a quantity with the times of its instrument: t in s, increasing, and one value for each time.
struct Series {
  std::vector<double> t_s, value;
};

/// Relation between the clocks of two instruments: t_reference = offset + rate * t_other.
struct ClockFit {
  double offset_s = 0, rate = 1;
  double offset_std_s = 0, rate_std = 0;  // standard uncertainties of the offset (at the middle of the
                                          // overlap) and of the rate, from the residuals
  double correlation = 0;  // correlation of both series in their overlap, after the alignment of the clocks
  double second_best = 0;  // next best correlation, at another lag; the result is ambiguous if it is nearly
                           // equal to `correlation`
};

/// Finds offset and rate between the clocks of two records of the same motion. Examples are encoder and
/// accelerometer (both as accelerations), and encoder and ball bar (both as lengths). The cross-correlation
/// of the resampled records gives the first estimate of the lag. Least squares then give offset, rate, gain
/// and mean in windows that grow from the middle to the whole overlap. The growing windows permit a rate
/// error of 1e-3 between both clocks. Throws InputError if a record has fewer than 16 samples, if times do
/// not increase, or if the records have no common motion (correlation below 0.5).
ClockFit align_clocks(const Series& reference, const Series& other);

/// Position on a sampled path, between the samples `sample` and `sample` + 1. `fraction` is the share of this
/// interval, 0..1; `distance` is the distance of the given point from the path.
struct PathPlace {
  std::size_t sample = 0;
  double fraction = 0, distance = 0;
};

/// Returns for each point (one column) the nearest position on the path (columns in order of time). The
/// search for the nearest path positions is for records without a common clock. The given points must be in
/// the order of the motion along the path. The search for a point starts at the position of the previous
/// point and covers at most the length `reach` of the path (mm). A second pass over the same positions is
/// therefore not confused with the first pass. The position of the first point is searched within the length
/// `reach` from the start of the path. Throws InputError if the path has fewer than two samples, or if path
/// and points have different numbers of axes.
std::vector<PathPlace> nearest_places(const Eigen::MatrixXd& path, const Eigen::MatrixXd& points,
                                      double reach);

}  // namespace vernier::vibration
