// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace vernier::offline {

/// Guide for the arcs that replace an arc of the program: the positions of the points of a path along this
/// arc.
struct ArcGuide {
  std::array<Eigen::Index, 2> axis{};  // rows of the plane's axes
  std::vector<double> angle;           // of each point about the program's centre, rad, in one direction
};

/// A block of a path: a straight line, or an arc. The arc has a centre in the plane of the guide and the
/// direction of the guide; all other axes move evenly with the angle.
struct PathPiece {
  Eigen::Index to = 0;  // the point that it ends in; it begins where the piece before ended
  std::optional<Eigen::Vector2d> centre;
  bool whole = false;  // a full turn: ends at its start point in its plane
};

/// Finds few blocks from the first point to the last. Each block is as long as possible, with all points
/// between its ends within `most` of the block (norm over all axes, one point per column). Arcs pass through
/// the points at their ends and turn by at most 270 degrees, or one full turn. If a line reaches as far as an
/// arc, the line is used. The position along a block depends on the time, not on the path. If no guide is
/// given, fit_path uses only lines.
std::vector<PathPiece> fit_path(const Eigen::MatrixXd& points, const std::optional<ArcGuide>& guide,
                                double most);

/// Returns the distance of a position from a piece of the path that begins at `from` (norm over all axes, as
/// above).
double distance_from(const PathPiece& piece, const Eigen::MatrixXd& points, Eigen::Index from,
                     const std::optional<ArcGuide>& guide, const Eigen::VectorXd& place);

}  // namespace vernier::offline
