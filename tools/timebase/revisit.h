// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::timebase {

/// Returns the commanded axis positions of some rows as points: rows x axes, each axis in shares of its range
/// over those rows. An axis without motion is excluded.
Eigen::MatrixXd path_points(const model::Measurement& m, const std::vector<std::size_t>& rows);

/// Returns for each point the number of rows after which the path passes the point again in the same
/// direction, interpolated between two rows by projection. The result is NaN if the path does not return to
/// the point. A pause at a point is not a return. Poses that were set one by one (steps of a tenth of the
/// extent) are not a path. `points`: from path_points, in time order.
Eigen::VectorXd revisit_lags(const Eigen::MatrixXd& points);

/// Two paths over the same points: position on the second = offset + rate * row of the first
/// (rows).
struct PathMap {
  double offset = 0, rate = 0;  // rate < 0: the second path has the opposite direction
  double share = 0;             // of the first path's rows that lie on this line within two rows
};

/// Returns the map from one path to another by their positions; nullopt if less than 70 % of the first path
/// is on one line. first, second: points of the same axes, in the same unit.
std::optional<PathMap> map_paths(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second);

}  // namespace vernier::timebase
