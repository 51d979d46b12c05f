// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/parameters.h"
#include "tools/model/states.h"

namespace vernier::plan {

struct FirstPlanOptions {
  /// Required expanded uncertainty (k = 2) of the tool point over the work volume, um. The plan ends when
  /// the required expanded uncertainty is reached. nullopt: the expanded uncertainty of one reading.
  std::optional<double> accuracy_um;
  double reading_um = 5;      // standard uncertainty of one coordinate of the planned readings
  double expected_um = 100;   // plausible motion of the tool point by one parameter, rms over the volume
  std::size_t most = 400;     // largest number of poses
  double check_share = 0.15;  // share of additional poses that only test the fit
};

/// The free parameters of a machine, each in units of its plausible size.
struct PlannedParameters {
  model::ParameterSet all;
  std::vector<Eigen::Index> own, set_up;  // indices of the machine's own parameters, and of the parameters of
                                          // its BaseShift
  Eigen::VectorXd scale;                  // plausible size of each parameter, in its unit
  model::States offered;                  // poses over the working ranges that the plan may select, with both
                                          // approach directions
  Eigen::MatrixXd jacobian;               // Jacobian of the tool point at these poses, three rows per pose,
                                          // in units of the plausible sizes
  Eigen::MatrixXd weight;                 // matrix that converts a covariance in these units to a variance of
                                          // the tool point, mm^2

  /// Returns the expanded uncertainty (k = 2) of the tool point over the volume, um, for a covariance of the
  /// parameters. A rigid motion of the machine does not count.
  double expanded_um(const Eigen::MatrixXd& covariance) const;
};

/// Returns the parameters of a plan. The plausible size of a parameter is that which moves the tool point by
/// `expected_um`, rms over the volume. Throws InputError if an axis has no range or if no parameter is free.
PlannedParameters planned_parameters(const model::Machine& machine, double expected_um);

/// Poses for the first measurement of a machine.
struct FirstPlan {
  model::States states;                // poses in the order in which they are measured
  std::vector<char> check;             // true: check pose; false: pose for the fit
  std::size_t references = 0;          // number of repetitions of the first pose, which show a drift
  double before_um = 0, after_um = 0;  // expanded uncertainty of the tool point over the volume, without and
                                       // with the fit poses
  double random_um = 0;                // expanded uncertainty with the same number of random poses
  double least_um = 0;                 // lower limit of the expanded uncertainty with such readings, from all
                                       // possible poses
  bool reached = true;                 // true: the required accuracy is reached
};

/// Selects poses for the free parameters of the machine file, one after another. Each pose gives the largest
/// decrease of the expected uncertainty of the tool point over the work volume with all tools (I-optimal,
/// without exchange: Fedorov 1972, 2.5). A rigid motion of the machine does not count, because it belongs to
/// the set-up. The poses are in the order of a path through the travel of the axes. The first pose is
/// repeated, and check poses are distributed over the path. Throws InputError if an axis has no range or if
/// no parameter is free.
FirstPlan first_plan(const model::Machine& machine, const FirstPlanOptions& options = {});

/// Returns the expanded uncertainty (k = 2) of the tool point over the work volume, um, after readings at the
/// given poses. The computation is the same as for `after_um`.
double planned_uncertainty_um(const model::Machine& machine, const model::States& poses,
                              const FirstPlanOptions& options = {});

/// Returns a measurement file with the poses of the plan, in which the user enters the readings.
std::string first_plan_csv(const model::Machine& machine, const FirstPlan& plan, double reading_um);

}  // namespace vernier::plan
