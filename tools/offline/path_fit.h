// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace vernier::offline {

/// Data for arcs that replace an arc of the program: the angles of the points of a path along this arc.
struct ArcGuide {
  std::array<Eigen::Index, 2> axis{};  // rows of the two axes of the plane
  std::vector<double> angle;           // angle of each point about the centre of the program's arc, rad, in
                                       // one direction
};

/// A block of a fitted path: a straight line or an arc. The arc has a centre in the plane of the guide, and
/// its direction. All other axes move in proportion to the angle.
struct PathPiece {
  Eigen::Index to = 0;  // index of the point at the end of the block; the block begins at the end of the
                        // previous block
  std::optional<Eigen::Vector2d> centre;
  bool whole = false;  // true: a full turn, which ends at its start point in the plane
};

/// Returns a small number of blocks that connect the first point to the last point. Each block of the fitted
/// path is as long as possible. All points between its ends must be within `most` of the block (norm over
/// all axes, one column per point). An arc passes through the points at its ends. An arc turns by at most
/// 270 degrees, or by one full turn. If a line reaches as far as an arc, the line is used. The position
/// along a block is a function of the time, not of the path length. If no guide is given, fit_path uses only
/// straight lines.
std::vector<PathPiece> fit_path(const Eigen::MatrixXd& points, const std::optional<ArcGuide>& guide,
                                double most);

/// Returns the distance between a position and a block of the path that begins at the point `from` (norm over
/// all axes).
double distance_from(const PathPiece& piece, const Eigen::MatrixXd& points, Eigen::Index from,
                     const std::optional<ArcGuide>& guide, const Eigen::VectorXd& place);

}  // namespace vernier::offline
