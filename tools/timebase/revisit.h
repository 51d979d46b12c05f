// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::timebase {

/// Commanded axis positions of some rows as points: rows x axes, each axis in shares of its range over those
/// rows; an axis that stands still is left out. tool.
Eigen::MatrixXd path_points(const model::Measurement& m, const std::vector<std::size_t>& rows);

/// How many rows later the path passes each point again in the same sense, the row between two by projection;
/// NaN where it does not. A pause at a point is no return; poses set one by one (steps of a tenth of the
/// extent) are no path. `points`: as path_points gives them, in time order. tool.
Eigen::VectorXd revisit_lags(const Eigen::MatrixXd& points);

/// Two paths over the same points: place on the second = offset + rate * row of the first (rows).
struct PathMap {
  double offset = 0, rate = 0;  // rate < 0: the second runs the other way round
  double share = 0;             // of the first path's rows that lie on this line within two rows
};

/// How the positions map one path onto another; nothing where less than 70 % of the first lies on one line.
/// Both: points of the same axes, in the same unit. tool.
std::optional<PathMap> map_paths(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second);

}  // namespace vernier::timebase
