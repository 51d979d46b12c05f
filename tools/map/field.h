// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/kinematics/closed.h"

namespace vernier::map {

/// Deviation vectors on a grid over the ranges of one to three axes.
struct ErrorField {
  std::vector<std::size_t> axes;    // swept; the first one changes fastest
  std::vector<std::size_t> counts;  // number of nodes along each
  model::States states;             // one per node
  Eigen::Matrix3Xd nominal;         // tool point of the nominal chain, mm
  Eigen::Matrix3Xd deviation;       // actual - nominal, mm
};

/// Returns the field over the declared ranges of `axes`, `count` nodes along each. Other axes, motion and
/// inputs are as in `at` (count 1). Throws InputError: an axis without min and max, no axis or more than
/// three.
ErrorField error_field(const model::Machine& machine, const model::States& at,
                       const std::vector<std::size_t>& axes, std::size_t count);

/// Returns the deviation that remains at the nodes of a field of `machine` if the axes get the offsets that
/// the model `correction` gives for the same commands: 3 x nodes, mm. The linear axes are corrected; on a
/// machine without linear axes all axes. Throws InputError if `correction` has an axis that the machine
/// lacks, or if its offsets do not converge at a node.
Eigen::Matrix3Xd corrected_deviation(const model::Machine& machine, const ErrorField& field,
                                     const model::Machine& correction);

/// A machine on which measurements are simulated. The nominal chain gives the command; the machine itself
/// gives the actual position. The linear axes come from the closed inverse solution if the nominal chain has
/// one, else from iteration.
class Bench {
 public:
  /// Throws InputError if the chain has no linear axis, more than three, or a linear axis without a range.
  Bench(const model::Machine& machine, const model::States& at);

  const std::vector<std::size_t>& axes() const { return axes_; }
  /// Returns the nominal tool point (mm) with the linear axes at these fractions (0..1) of their
  /// ranges.
  Eigen::Vector3d point_at(const Eigen::VectorXd& fraction) const;
  /// True if the linear axes can bring the nominal tool point to all of these points (3 x N, mm), without
  /// regard to ranges.
  bool meets(const Eigen::Matrix3Xd& points) const;
  /// True if the linear axes can bring the nominal tool point to all of these points within their ranges.
  bool reaches(const Eigen::Matrix3Xd& points) const;
  /// Returns the actual tool points if these points are commanded one after another, at rest at each point.
  /// Directions of motion and travel since reversal are those of this path. The first point is approached in
  /// the same direction as the second.
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
