// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/kinematics/closed.h"

namespace vernier::map {

/// Deviation vectors on a grid over the ranges of one to three axes (error field).
struct ErrorField {
  std::vector<std::size_t> axes;    // axes of the grid; the position of the first axis changes fastest
  std::vector<std::size_t> counts;  // number of nodes along each axis
  model::States states;             // one state for each node
  Eigen::Matrix3Xd nominal;         // tool point of the nominal chain, mm
  Eigen::Matrix3Xd deviation;       // actual - nominal, mm
};

/// Returns the error field over the declared ranges of `axes`, with `count` nodes along each axis. The other
/// axes, the motion and the inputs have the values of the state `at`. Throws InputError if an axis has no min
/// and max, or if there are no axes or more than three.
ErrorField error_field(const model::Machine& machine, const model::States& at,
                       const std::vector<std::size_t>& axes, std::size_t count);

/// Returns the deviation that remains at the nodes of an error field of `machine` after a correction, 3 x
/// nodes, mm. The axis offsets are those that the model `correction` gives for the same commands. Only the
/// linear axes are corrected; on a machine without linear axes, all axes are corrected. Throws InputError if
/// `correction` has an axis that the machine does not have, or if its offsets do not converge at a node.
Eigen::Matrix3Xd corrected_deviation(const model::Machine& machine, const ErrorField& field,
                                     const model::Machine& correction);

/// A machine on which measurements are simulated (virtual test bench). The nominal chain gives the commands,
/// and the machine with its errors gives the actual positions. The positions of the linear axes come from the
/// closed-form inverse solution if the nominal chain has one; otherwise they come from an iteration.
class Bench {
 public:
  /// Throws InputError if the chain has no linear axis, more than three linear axes, or a linear axis without
  /// a range.
  Bench(const model::Machine& machine, const model::States& at);

  const std::vector<std::size_t>& axes() const { return axes_; }
  /// Returns the nominal tool point (mm) with the linear axes at the given fractions (0..1) of their ranges.
  Eigen::Vector3d point_at(const Eigen::VectorXd& fraction) const;
  /// True if the linear axes can bring the nominal tool point to all given points (3 x N, mm). This test
  /// ignores the ranges of the axes.
  bool meets(const Eigen::Matrix3Xd& points) const;
  /// True if the linear axes can bring the nominal tool point to all given points within their ranges.
  bool reaches(const Eigen::Matrix3Xd& points) const;
  /// Returns the actual tool points if the given points are commanded one after another, at rest at each
  /// point. The directions of motion and the travel since the last reversal are those of this path. The first
  /// point is approached in the direction in which the second point is approached.
  Eigen::Matrix3Xd measure(const Eigen::Matrix3Xd& points) const;

 private:
  bool comes_to(const Eigen::MatrixXd& positions, const Eigen::Matrix3Xd& points) const;
  model::States standing_at(const Eigen::MatrixXd& positions) const;
  Eigen::MatrixXd positions_of(const Eigen::Matrix3Xd& points) const;
  model::States states_of(const Eigen::MatrixXd& positions) const;

  const model::Machine& machine_;
  model::Machine nominal_;
  model::States at_;
  std::vector<std::size_t> axes_;
  std::optional<kinematics::ClosedSolution> closed_;
};

}  // namespace vernier::map
