// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::lint {

/// Points along an axis that are much denser than the stations of its table.
struct DensePoints {
  std::string axis, unit;      // unit: mm or deg
  std::size_t positions = 0;   // different positions of the axis in rows in which it moved alone
  double spacing = 0;          // median distance of neighbouring positions
  double station_spacing = 0;  // median distance of the stations in the measured range
  double step = 0;             // proposed distance of the stations
  bool one_column = false;     // true: the line measures one of several columns of the table (a laser)
};

/// Finds tables whose stations are more than three times as far apart as the points of a survey. The curve
/// between two stations then remains in the residual, where it can look like a cyclic error. Only rows count
/// in which one axis moved alone: poses all over the volume have other positions in each row. The proposed
/// stations have at least three readings of these rows for each station and each fitted column of the table;
/// without such stations there is no proposal. `positions`: positions of each axis of the machine in each
/// row; an axis without a column has an empty list. `readings`: number of readings of each row.
std::vector<DensePoints> dense_points(const model::Machine& machine,
                                      const std::vector<std::vector<double>>& positions,
                                      const std::vector<std::size_t>& readings);

/// As above, for the rows of a survey.
std::vector<DensePoints> dense_points(const model::Machine& machine, const model::Measurement& survey);

/// "X: 41 positions 25 mm apart, stations 200 mm apart", and what to do.
std::string dense_points_text(const DensePoints& points);
std::string dense_points_remedy(const DensePoints& points);

}  // namespace vernier::lint
