// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// Readings x, y, z of the tool point at every state, of value 0: for what a machine makes of them, not for a
/// fit. In messages a row is "point:N", N from 1.
model::Measurement point_readings(const model::States& states);

/// Velocity of each point under the six rigid motions about the origin, 3 N x 6.
Eigen::MatrixXd rigid_motions(const Eigen::Matrix3Xd& points);

/// How well the last fit of a machine knows where its tool is: anywhere, with any tool and input, whether it
/// was measured there or not. From the covariance that the machine file keeps (`<fitted>`), in which what the
/// readings left open has the spread of its scale.
class Reach {
 public:
  /// A machine without a fit knows nothing: known() is false.
  explicit Reach(const model::Machine& machine);

  bool known() const { return known_; }
  /// Free parameters that are not as the fit left them: added or set by hand since. They count as uncertain
  /// by as much as they were moved.
  const std::vector<std::string>& stale() const { return stale_; }

  /// Covariance (mm^2) of the deviation at each state, in workpiece coordinates, but for a rigid motion of
  /// the whole: the one that fits best over the measured ranges with the tool that this machine has. Such a
  /// motion is set-up, no correction can take it away and nobody misses it. Throws InputError where the chain
  /// is not finite.
  std::vector<Eigen::Matrix3d> covariance(const model::States& states) const;

  /// Root of the trace, um.
  Eigen::VectorXd std_um(const model::States& states) const;

 private:
  Eigen::MatrixXd spread_at(const model::States& states) const;
  /// The motion of the whole that each column of the factor is (6 x k), with hidden axes (a choice of tool)
  /// as in `like` at `row`, other inputs at their reference.
  Eigen::MatrixXd rigid_part(const model::States& like, Eigen::Index row) const;

  model::Machine machine_;
  bool known_ = false;
  model::ParameterSet parameters_;
  Eigen::MatrixXd factor_;  // n x k: rows of the record's factor, by parameter
  model::States measured_;  // poses over the measured ranges
  std::vector<std::string> stale_;
};

}  // namespace vernier::fit
