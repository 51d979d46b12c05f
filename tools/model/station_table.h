// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::model {

/// Interpolation in a station table: linear or cubic (natural, or periodic). Beyond both ends of the table
/// the last value is used. If the axis rolls over, the table is periodic. The result is linear in the values
/// at the stations; weights() gives the weight of each station.
class StationTable {
 public:
  explicit StationTable(const Table& table);

  /// Returns the six values (mm, deg) at a raw axis position.
  std::array<double, 6> values(double raw) const;
  /// Returns d value / d raw of the six columns; 0 beyond the ends.
  std::array<double, 6> slopes(double raw) const;
  /// Appends index and weight of every station that contributes to the value at this position. In a periodic
  /// table the last station repeats the first station; its weight is added to index 0.
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
  Eigen::MatrixXd curvature_;                // cubic: second derivatives = curvature_ * station values
  std::vector<std::array<double, 6>> bend_;  // cubic: second derivative of the six columns at every station
};

/// Returns the values of a table at a raw axis position, mm and deg; node, edge and periodic rules of
/// FORMATS.
std::array<double, 6> table_values(const Table& table, double raw);

}  // namespace vernier::model
