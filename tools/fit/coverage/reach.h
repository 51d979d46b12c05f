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

/// Uncertainty of the tool position after the last fit of a machine. The uncertainty is available at any
/// measured or unmeasured pose, with any tool and any input. The uncertainty is computed from the covariance
/// in the machine file (`<fitted>`). A parameter that the readings do not determine has an uncertainty equal
/// to its scale.
class Reach {
 public:
  /// Constructs the Reach (uncertainty of the tool position) of a machine. known() returns false if the
  /// machine was not fitted.
  explicit Reach(const model::Machine& machine);

  bool known() const { return known_; }
  /// Returns the names of free parameters that differ from the last fit because they were added or changed by
  /// hand later. The uncertainty of a parameter that was changed by hand is the difference between its
  /// present value and its fitted value.
  const std::vector<std::string>& stale() const { return stale_; }

  /// Returns the covariance (mm^2) of the deviation at each state, in workpiece coordinates, under the
  /// condition that the model is right. The covariance of the deviation contains the uncertainty of
  /// the fit, and the errors that the readings of the fit could not show
  /// (tools/fit/coverage/unmeasured.h). A rigid motion of the whole machine is removed from the
  /// covariance. The removed rigid motion is the best fit over the measured ranges with the present
  /// tool. A rigid motion of the whole machine belongs to the set-up; no correction can remove it.
  /// Throws InputError if the chain is not finite.
  std::vector<Eigen::Matrix3d> covariance(const model::States& states) const;

  /// Returns the root of the trace of covariance() at each state, um.
  Eigen::VectorXd std_um(const model::States& states) const;
  /// Returns the covariance at each state, including the discrepancy that the readings showed
  /// (`<discrepancy>` of the fit record). The discrepancy is the standard deviation of errors of the real
  /// machine that the model does not contain.
  std::vector<Eigen::Matrix3d> covariance_of_machine(const model::States& states) const;
  Eigen::VectorXd std_of_machine_um(const model::States& states) const;
  /// Returns the part of the standard uncertainty that no reading of the fit determined. The undetermined
  /// part of the uncertainty comes from parameters at their scale, and from properties of the model that no
  /// reading confirms. The unit of the undetermined uncertainty is um, along x, y, z at each state. The
  /// function std_unmeasured_um() returns 0 if the machine file does not state which parameters are
  /// undetermined (open_known).
  Eigen::Matrix3Xd std_unmeasured_um(const model::States& states) const;
  /// Returns the standard deviation of the discrepancy, along x, y, z of workpiece coordinates, mm.
  const Eigen::Vector3d& discrepancy_mm() const { return discrepancy_mm_; }

  /// Returns the machine in workpiece coordinates, without set-ups. The functions parameters(), factor() and
  /// open() refer to this machine and its free parameters.
  const model::Machine& machine() const { return machine_; }
  const model::ParameterSet& parameters() const { return parameters_; }
  /// Returns the factor F of the covariance, n x k. The covariance of the parameters, in their units, is F
  /// F^T.
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// Returns the factor O of the undetermined part of the covariance, n x m. O O^T is the part of the
  /// covariance from parameters that no reading determines, and from parameters that were changed by hand.
  const Eigen::MatrixXd& open() const { return open_; }
  /// True if the machine file states which parameters the readings do not determine.
  bool open_known() const { return open_known_; }

  /// Returns the motion of the tool point at each state by each column of `change`, which is a change of the
  /// parameters (n x k). The rigid motion of the whole machine is removed from the columns: 3 N x k elements,
  /// mm. With factor() as `change`, the result times its own transpose is the covariance of the tool point.
  Eigen::MatrixXd moved(const model::States& states, const Eigen::MatrixXd& change) const;
  /// Returns the motion of the tool point by those properties of the model that no reading
  /// confirms. Each column is the motion of the tool point by one standard uncertainty of one
  /// property of the model. The rigid motion of the whole machine is removed from the columns: 3 N
  /// x e elements, mm.
  Eigen::MatrixXd moved_unmeasured(const model::States& states) const;
  /// Returns the same motion as moved_unmeasured(), including the rigid motion of the whole machine.
  Eigen::MatrixXd unmeasured(const model::States& states) const;

 private:
  using Columns = std::function<Eigen::MatrixXd(const model::States&)>;
  /// Returns the columns at each state after removal of their rigid motion of the whole machine.
  Eigen::MatrixXd without_rigid_part(const model::States& states, const Columns& columns) const;
  Eigen::MatrixXd moved_at(const model::States& states, const Eigen::MatrixXd& change) const;
  /// Returns the rigid motion of the whole machine in each column (6 x k). Hidden axes (the selection of a
  /// tool) have the values of row `row` of `like`. Other inputs have their reference values.
  Eigen::MatrixXd rigid_part(const model::States& like, Eigen::Index row, const Columns& columns) const;

  model::Machine machine_;
  bool known_ = false;
  model::ParameterSet parameters_;
  Eigen::MatrixXd factor_, open_;  // n x k and n x m elements: rows of the factors in the fit record, by
                                   // parameter
  bool open_known_ = false;
  model::FitRecord record_;
  Eigen::Vector3d discrepancy_mm_ = Eigen::Vector3d::Zero();
  model::States measured_;  // poses over the measured ranges of the axes
  std::vector<std::string> stale_;
};

}  // namespace vernier::fit
