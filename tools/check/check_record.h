// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::check {

/// A parameter that may have changed since the machine was fitted.
struct CheckedQuantity {
  std::string name, unit;
  bool of_instrument = false;
  bool operator==(const CheckedQuantity&) const = default;
};

/// Stored data of one check: the sensitivity of its readings to the tested parameters, in units of their
/// uncertainty, after projection of its set-ups.
struct CheckRecord {
  std::string label;                        // time or name of the check
  std::vector<CheckedQuantity> quantities;  // the machine's free parameters first, in their order
  std::size_t parameters = 0;               // how many of them are
  Eigen::MatrixXd gram;                     // tested parameters x tested parameters
  Eigen::VectorXd moment;
  double rest = 0, freedom = 0;  // chi^2 without all tested parameters, and its degrees of freedom
  double square = 0;             // chi^2 of the readings after projection of the set-ups; 0: not known
  std::size_t readings = 0;
  double beyond_set_up = 0;  // number of readings minus numbers of the set-up
};

/// True for a parameter of the machine that no reading of the fit determined (origin prior): a check cannot
/// distinguish a change of this parameter from its unknown value.
bool is_unmeasured(const model::Machine& machine, const CheckedQuantity& quantity);

/// Evaluates a measurement against a fitted machine; fit and check rows are treated alike. The set-up of the
/// instrument is fitted again, with any rotation. The sensitivities are computed at the new set-up. Tested
/// parameters are the free parameters. Further tested parameters, unless the chain has the same parameters as
/// free parameters: reversal and scale of every axis, a tilt and an offset of every transform, a drift of the
/// instrument along each direction that it reads. Throws InputError if the machine was never fitted.
CheckRecord record_of(const model::Machine& machine, const model::Measurement& measurement,
                      std::string label);

/// The tested parameters of CheckRecord as columns at the set-up of the machine file. A column is the effect
/// of a change by 1 on each reading, divided by the uncertainty of the reading.
struct QuantityColumns {
  std::vector<CheckedQuantity> quantities;
  std::size_t parameters = 0;
  Eigen::MatrixXd columns, set_up;  // readings x tested parameters, readings x numbers of the set-ups
};
QuantityColumns quantity_columns(const model::Machine& machine, const model::Measurement& measurement);

/// The fit's covariance of a record's parameters as L L^T: rows of L, 0 for parameters without a covariance
/// in the fit.
Eigen::MatrixXd spread_of_fit(const model::Machine& machine, const std::vector<CheckedQuantity>& quantities,
                              std::size_t parameters);

}  // namespace vernier::check
