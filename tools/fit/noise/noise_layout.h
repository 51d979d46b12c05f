// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/fit/noise/noise_thresholds.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// A series: the readings of one kind in the order of the file. Errors that are correlated in time, in a run
/// or at a pose are correlated along a series.
struct NoiseSeries {
  std::vector<Eigen::Index> reading;  // positions of the readings in the list of the layout
  std::vector<double> time;  // time, s; or row number if the times do not order the rows. The time never
                             // decreases within one clock.
  int kind = 0;              // kind of reading (ObservationKind)
  std::vector<std::size_t> row;
  std::vector<double> unit;  // um or arcsec of a weighted reading: u of the reading; 1 mm or 1 deg without u
  std::vector<int> setup, clock, pose;  // one index for each reading; a pose is a group of successive rows at
                                        // one position
  std::vector<Eigen::Vector3d> normal;  // normals of the readings along a normal
};

/// The readings of a list of observations, in the order that a noise model needs.
struct NoiseLayout {
  std::vector<NoiseSeries> series;
  bool in_time = false;    // true: time in s; false: time in rows
  bool has_runs = false;   // true: there is more than one run
  bool has_poses = false;  // true: at least one pose was read more than once in succession
  double step = 1,
         span = 1;      // step: median interval between rows. span: duration of the longest run. The step and
                        // the span are in the unit of time.
  double row_span = 1;  // number of rows in the longest run
};

/// Arranges the observations in series for a noise model. `observations`: indices into
/// measurement.observations, in increasing order. Rows belong to one pose if their positions differ by less
/// than a tolerance. The tolerance is in the gap between the small and the large steps between rows.
NoiseLayout noise_layout(const model::Measurement& measurement, const std::vector<std::size_t>& observations,
                         const LayoutThresholds& limits = {});

/// Returns an index of the position for each row of the measurement. Rows have the same index if all axes
/// have the same positions, also if the rows do not follow each other. Two positions of an axis are the same
/// if they differ by less than a tolerance. The tolerance is in the gap between the small and the large
/// distances of neighbouring positions. Exactly equal positions always have the same index.
std::vector<int> places_of_rows(const model::Measurement& measurement, const LayoutThresholds& limits = {});

/// True if readings of this kind drift. `kinds`: the kinds of reading that drift (bit n is kind n); 0: all
/// kinds drift.
constexpr bool is_drifting(std::uint32_t kinds, int kind) { return kinds == 0 || (kinds >> kind & 1U) != 0; }

/// Returns the interval between reading `i` of a series and the previous reading: s if `in_time` is true,
/// otherwise rows.
double passed(const NoiseSeries& series, std::size_t i, bool in_time);

}  // namespace vernier::fit
