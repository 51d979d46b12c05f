// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/fit/noise/noise_thresholds.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Readings of one kind in the order of the file. An error that is correlated in time, run or pose
/// is common along the series.
struct NoiseSeries {
  std::vector<Eigen::Index> reading;  // positions in the list of the layout
  std::vector<double> time;  // s, or rows if time does not order them; never decreasing within a clock
  int kind = 0;              // of ObservationKind
  std::vector<std::size_t> row;
  std::vector<int> setup, clock, pose;  // one index each; a pose: successive rows at one position
  std::vector<Eigen::Vector3d> normal;  // of readings along a normal
};

/// The readings of a list of observations, arranged for a noise model.
struct NoiseLayout {
  std::vector<NoiseSeries> series;
  bool in_time = false;    // time is s, else rows
  bool has_runs = false;   // more than one
  bool has_poses = false;  // some pose was read more than once in succession
  double step = 1,
         span = 1;      // median interval between rows, duration of the longest run, in the unit of time
  double row_span = 1;  // longest run, rows
};

/// Orders the observations for a noise model. observations: indices into measurement.observations, in their
/// order. Positions belong to one pose if they differ by less than a tolerance. The gap between small and
/// large steps gives the tolerance.
NoiseLayout noise_layout(const model::Measurement& measurement, const std::vector<std::size_t>& observations,
                         const LayoutThresholds& limits = {});

/// Returns the number of the position of each row. Rows have the same number if all axes have the same
/// positions, at any time. On each axis, positions are the same if they differ by less than a tolerance. The
/// gap between small and large distances of neighbours gives the tolerance. Exactly equal positions always
/// have the same number.
std::vector<int> places_of_rows(const model::Measurement& measurement, const LayoutThresholds& limits = {});

/// True if readings of this kind drift. kinds: those that drift (bit n is kind n); 0: all.
constexpr bool is_drifting(std::uint32_t kinds, int kind) { return kinds == 0 || (kinds >> kind & 1U) != 0; }

/// Returns the interval between a reading of a series and the previous reading: s, or rows.
double passed(const NoiseSeries& series, std::size_t i, bool in_time);

}  // namespace vernier::fit
