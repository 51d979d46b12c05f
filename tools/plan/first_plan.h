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
  /// Expanded uncertainty (k = 2) of the tool point over the work volume at which the plan is long enough,
  /// um; nullopt: that of one reading.
  std::optional<double> accuracy_um;
  double reading_um = 5;     // standard uncertainty of a coordinate that will be read
  double expected_um = 100;  // by how much a parameter may plausibly move the tool point, rms over the volume
  std::size_t most = 400;    // poses
  double check_share = 0.15;  // share of additional poses that only test the fit
};

/// The free parameters of a machine, each in units of its plausible size.
struct PlannedParameters {
  model::ParameterSet all;
  std::vector<Eigen::Index> own, set_up;  // indices: of the machine, of its BaseShift
  Eigen::VectorXd scale;                  // unit of each parameter
  model::States offered;                  // poses over the working ranges, with both approach directions
  Eigen::MatrixXd jacobian;               // of the tool point at these poses, three rows each, in the units
  Eigen::MatrixXd weight;                 // maps a covariance in these units to the tool point, mm^2

  /// Returns the expanded uncertainty (k = 2) of the tool point over the volume, um, without a rigid motion.
  double expanded_um(const Eigen::MatrixXd& covariance) const;
};

/// Returns the parameters of a plan; a parameter may move the tool point by `expected_um`, rms over the
/// volume. Throws InputError for an axis without a range, or without a free parameter.
PlannedParameters planned_parameters(const model::Machine& machine, double expected_um);

/// Poses for the first measurement of a machine.
struct FirstPlan {
  model::States states;                // in the order in which they are measured
  std::vector<char> check;             // role of each
  std::size_t references = 0;          // of them: the first pose again, that a drift shows
  double before_um = 0, after_um = 0;  // expanded uncertainty over the volume, without and with the fit poses
  double random_um = 0;                // the same from as many poses at random
  double least_um = 0;                 // from all possible poses: lower limit of such readings
  bool reached = true;                 // the accuracy that was asked for
};

/// Chooses poses one by one; each pose gives the largest decrease of the expected uncertainty of the tool
/// point over the work volume with all tools, for the free parameters of the machine file (I-optimal, without
/// exchange: Fedorov 1972, 2.5). A rigid motion belongs to the set-up and does not count. The poses are in
/// the order of a path through the axes' travels; the first pose is repeated, check poses are in between.
/// Throws InputError for an axis without a range, or without a free parameter.
FirstPlan first_plan(const model::Machine& machine, const FirstPlanOptions& options = {});

/// Returns the expanded uncertainty (k = 2) of the tool point over the work volume, um, after readings at any
/// poses, computed like `after_um`.
double planned_uncertainty_um(const model::Machine& machine, const model::States& poses,
                              const FirstPlanOptions& options = {});

/// Returns a measurement file with the poses of the plan; the readings must be filled in.
std::string first_plan_csv(const model::Machine& machine, const FirstPlan& plan, double reading_um);

}  // namespace vernier::plan
