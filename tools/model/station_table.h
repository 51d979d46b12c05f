// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::model {

/// Interpolation in a station table: linear, cubic (natural spline), or cubic periodic. Outside the range of
/// the stations, the value of the first or last station is used. The table is periodic if the axis has
/// rollover. The interpolated value is linear in the values at the stations. The function weights() returns
/// the weight of each station.
class StationTable {
 public:
  explicit StationTable(const Table& table);

  /// Returns the six table values (mm, deg) at a position of the axis without scale factor.
  std::array<double, 6> values(double raw) const;
  /// Returns the slopes of the six columns, d value / d raw; 0 outside the range of the stations.
  std::array<double, 6> slopes(double raw) const;
  /// Appends the index and the weight of every station that contributes to the value at the position `raw`.
  /// In a periodic table the last station repeats the first station. The weight of the last station is added
  /// to index 0.
  void weights(double raw, std::vector<std::pair<std::size_t, double>>& result) const;

 private:
  struct Spot {
    std::size_t segment = 0;
    double fraction = 0, width = 1;
    bool held = false;
  };
  Spot spot(double raw) const;

  const Table& table_;
  std::vector<double> loc_;
  Eigen::MatrixXd curvature_;                // for cubic interpolation: second derivatives = curvature_ *
                                             // station values
  std::vector<std::array<double, 6>> bend_;  // for cubic interpolation: second derivative of the six columns
                                             // at every station
};

/// Returns the six values of a table (mm, deg) at the axis position `raw`, by the rules of FORMATS for
/// stations, ends and periodic tables.
std::array<double, 6> table_values(const Table& table, double raw);

}  // namespace vernier::model
