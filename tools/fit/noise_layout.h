// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/fit/noise_thresholds.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Readings of one kind in the order of the file: an error that is correlated in time, run or pose is
/// common along it.
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
NoiseLayout noise_layout(const model::Measurement& measurement, const std::vector<std::size_t>& observations,
                         const LayoutThresholds& limits = {});

/// The place of each row, numbered: where all axes stand alike, whenever that was. On each axis positions
/// count as alike where they differ by less than a tolerance that the gap between small and large distances
/// of neighbours gives; equal ones always. tool.
std::vector<int> places_of_rows(const model::Measurement& measurement, const LayoutThresholds& limits = {});

/// What passes between a reading of a series and the one before it: s, or rows.
double passed(const NoiseSeries& series, std::size_t i, bool in_time);

}  // namespace vernier::fit
