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

/// Uncertainty of the tool position by the last fit of a machine: at any pose, with any tool and input,
/// measured or not. The uncertainty comes from the covariance in the machine file (`<fitted>`). Parameters
/// that the readings do not determine have the uncertainty of their scale.
class Reach {
 public:
  /// Constructs the Reach of a machine. known() returns false for a machine that was not fitted.
  explicit Reach(const model::Machine& machine);

  bool known() const { return known_; }
  /// Returns the free parameters that differ from the fit: added or set by hand later. The uncertainty of
  /// such a parameter is the size of the difference between its present value and its value in the fit.
  const std::vector<std::string>& stale() const { return stale_; }

  /// Returns the covariance (mm^2) of the deviation at each state, in workpiece coordinates, if the model is
  /// right. The covariance contains the uncertainty of the fit, and the errors that the readings of the fit
  /// could not show (tools/fit/coverage/unmeasured.h). A rigid motion of the whole is removed: the best fit
  /// over the measured ranges with the present tool of the machine. A rigid motion of the whole machine
  /// belongs to the set-up; no correction can remove it. Throws InputError if the chain is not finite.
  std::vector<Eigen::Matrix3d> covariance(const model::States& states) const;

  /// Root of the trace, um.
  Eigen::VectorXd std_um(const model::States& states) const;
  /// Returns the covariance with the discrepancy that the readings showed (`<discrepancy>` of the record).
  /// The discrepancy is the possible difference between the real machine and the model.
  std::vector<Eigen::Matrix3d> covariance_of_machine(const model::States& states) const;
  Eigen::VectorXd std_of_machine_um(const model::States& states) const;
  /// Returns the part of the standard uncertainty that no reading of the fit determined: parameters at their
  /// scale, and properties of the model that no reading confirms. Along x, y, z at each state, um. 0 if the
  /// machine file does not state these parameters (open_known).
  Eigen::Matrix3Xd std_unmeasured_um(const model::States& states) const;
  /// Returns the standard deviation of the discrepancy, along x, y, z of workpiece coordinates, mm.
  const Eigen::Vector3d& discrepancy_mm() const { return discrepancy_mm_; }

  /// Returns the machine in workpiece coordinates, without set-ups; parameters() are those of this machine.
  /// factor() and open() refer to this machine and its free parameters.
  const model::Machine& machine() const { return machine_; }
  const model::ParameterSet& parameters() const { return parameters_; }
  /// Returns F, n x k. The covariance of the parameters, in their units, is F F^T.
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// Returns O, n x m. O O^T is the part of the covariance from parameters that no reading determines, and
  /// from parameters that were set by hand.
  const Eigen::MatrixXd& open() const { return open_; }
  /// False if the machine file does not state which parameters the readings leave undetermined.
  bool open_known() const { return open_known_; }

  /// Returns the motion of the tool point at each state due to each column of `change`, a change of the
  /// parameters (n x k). The rigid motion of the whole is removed as above: 3 N x k, mm. With `factor` as
  /// change, the result times its own transpose is the covariance of the tool point.
  Eigen::MatrixXd moved(const model::States& states, const Eigen::MatrixXd& change) const;
  /// Returns the motion of the tool point by those properties of the model that no reading confirms, one
  /// standard uncertainty per column. The rigid motion of the whole is removed: 3 N x e, mm.
  Eigen::MatrixXd moved_unmeasured(const model::States& states) const;
  /// Returns the same motion as moved_unmeasured(), including the rigid motion of the whole machine.
  Eigen::MatrixXd unmeasured(const model::States& states) const;

 private:
  using Columns = std::function<Eigen::MatrixXd(const model::States&)>;
  /// Returns the columns at each state minus their rigid motion of the whole machine.
  Eigen::MatrixXd without_rigid_part(const model::States& states, const Columns& columns) const;
  Eigen::MatrixXd moved_at(const model::States& states, const Eigen::MatrixXd& change) const;
  /// Returns the motion of the whole in each column (6 x k). Hidden axes (a choice of tool) have their value
  /// in `like` at `row`; other inputs are at their reference.
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
