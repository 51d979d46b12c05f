// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::timebase {

/// Returns the commanded axis positions of rows as points: rows x axes, each axis in units of its range over
/// these rows. An axis without motion is excluded.
Eigen::MatrixXd path_points(const model::Measurement& m, const std::vector<std::size_t>& rows);

/// Returns, for each point of a path, the number of rows after which the path passes the point again in the
/// same direction. The number of rows until the return is interpolated between two rows by projection. The
/// number of rows is NaN if the path does not return to the point. A pause of the motion at a point does not
/// count as a return. Poses that were set one by one (steps of a tenth of the extent) do not count as a
/// path. `points`: result of path_points, in time order.
Eigen::VectorXd revisit_lags(const Eigen::MatrixXd& points);

/// Relation between two paths over the same points: row on the second path = offset + rate * row on the first
/// path.
struct PathMap {
  double offset = 0, rate = 0;  // rate < 0: the second path has the opposite direction
  double share = 0;             // share of the rows of the first path that agree with this relation within
                                // two rows
};

/// Returns the relation between two paths from their positions; nullopt if less than 70 % of the first path
/// agrees with one linear relation. `first`, `second`: points of the same axes, in the same unit.
std::optional<PathMap> map_paths(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second);

}  // namespace vernier::timebase
