// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/model/states.h"

namespace vernier::fit {

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

  /// Covariance (mm^2) of the deviation at each state, in workpiece coordinates, as far as the model is
  /// right: what the fit does not know, and what its readings could not show (tools/fit/unmeasured.h). But
  /// for a rigid motion of the whole: the one that fits best over the measured ranges with the tool that this
  /// machine has. Such a motion is set-up, no correction can take it away and nobody misses it. Throws
  /// InputError where the chain is not finite.
  std::vector<Eigen::Matrix3d> covariance(const model::States& states) const;

  /// Root of the trace, um.
  Eigen::VectorXd std_um(const model::States& states) const;
  /// The same with what the readings showed the model to lack (`<discrepancy>` of the record): how far the
  /// real machine may be from the model.
  std::vector<Eigen::Matrix3d> covariance_of_machine(const model::States& states) const;
  Eigen::VectorXd std_of_machine_um(const model::States& states) const;
  /// Standard deviation of what the model lacks, along x, y, z of workpiece coordinates, mm.
  const Eigen::Vector3d& discrepancy_mm() const { return discrepancy_mm_; }

  /// The machine in workpiece coordinates alone, and its free parameters: what the factors below go with.
  const model::Machine& machine() const { return machine_; }
  const model::ParameterSet& parameters() const { return parameters_; }
  /// n x k, covariance = F F^T of the parameters, in their units.
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// n x m, part O O^T of the covariance: what no reading bears on, and what was set by hand.
  const Eigen::MatrixXd& open() const { return open_; }
  /// False where the file does not say what its readings left open.
  bool open_known() const { return open_known_; }

  /// What a change of the parameters by each column of `change` (n x k) moves the tool point by at each
  /// state, but for the rigid motion of the whole as above: 3 N x k, mm. With `factor` its covariance is the
  /// product with its own transpose.
  Eigen::MatrixXd moved(const model::States& states, const Eigen::MatrixXd& change) const;
  /// What claims that no reading supports may move the tool point by, one standard uncertainty a column, but
  /// for the rigid motion of the whole: 3 N x e, mm.
  Eigen::MatrixXd moved_unmeasured(const model::States& states) const;
  /// The same with the motion of the whole in it.
  Eigen::MatrixXd unmeasured(const model::States& states) const;

 private:
  using Columns = std::function<Eigen::MatrixXd(const model::States&)>;
  /// Columns at each state less the motion of the whole that each is.
  Eigen::MatrixXd without_rigid_part(const model::States& states, const Columns& columns) const;
  Eigen::MatrixXd moved_at(const model::States& states, const Eigen::MatrixXd& change) const;
  /// The motion of the whole that each column is (6 x k), with hidden axes (a choice of tool) as in `like` at
  /// `row`, other inputs at their reference.
  Eigen::MatrixXd rigid_part(const model::States& like, Eigen::Index row, const Columns& columns) const;

  model::Machine machine_;
  bool known_ = false;
  model::ParameterSet parameters_;
  Eigen::MatrixXd factor_, open_;  // n x k, n x m: rows of the record's factors, by parameter
  bool open_known_ = false;
  model::FitRecord record_;
  Eigen::Vector3d discrepancy_mm_ = Eigen::Vector3d::Zero();
  model::States measured_;  // poses over the measured ranges
  std::vector<std::string> stale_;
};

}  // namespace vernier::fit
