// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::check {

/// A parameter of the machine that may have changed since the last fit.
struct CheckedQuantity {
  std::string name, unit;
  bool of_instrument = false;
  bool operator==(const CheckedQuantity&) const = default;
};

/// Stored data of one check. The rows are the sensitivities of the readings to the tested parameters, in
/// units of the readings' uncertainty, after projection of the set-ups.
struct CheckRecord {
  std::string label;                        // time or name of the check
  std::vector<CheckedQuantity> quantities;  // tested parameters; the free parameters of the machine are
                                            // first, in their order
  std::size_t parameters = 0;               // number of free parameters of the machine
  Eigen::MatrixXd gram;                     // Gram matrix: tested parameters x tested parameters
  Eigen::VectorXd moment;
  double rest = 0, freedom = 0;  // chi^2 with all tested parameters fitted, and its degrees of freedom
  double square = 0;             // chi^2 of the readings after projection of the set-ups; 0: unknown
  std::size_t readings = 0;
  double beyond_set_up = 0;  // number of readings minus number of set-up parameters
};

/// True if no reading of the fit determined this parameter (origin prior). A check cannot distinguish a
/// change of a parameter that no reading determined from its unknown value.
bool is_unmeasured(const model::Machine& machine, const CheckedQuantity& quantity);

/// Compares a measurement with a fitted machine. The comparison uses fit rows and check rows of the
/// measurement in the same way. The set-up of the instrument is fitted again, with any rotation. The
/// sensitivities of the readings are computed at the set-up that is fitted again. All free parameters of the
/// machine are tested. The check also tests reversal and scale of every axis, a tilt and an offset of every
/// transform, and a drift of the instrument along each direction that it reads, if the chain has no free
/// parameters for them. Throws InputError if the machine was never fitted.
CheckRecord record_of(const model::Machine& machine, const model::Measurement& measurement,
                      std::string label);

/// Design matrix of the tested parameters (CheckRecord), at the set-up of the machine file. A column of this
/// matrix is the effect of a change by 1 on each reading, divided by the uncertainty of the reading.
struct QuantityColumns {
  std::vector<CheckedQuantity> quantities;
  std::size_t parameters = 0;
  Eigen::MatrixXd columns, set_up;  // columns: readings x tested parameters; set_up: readings x set-up
                                    // parameters
};
QuantityColumns quantity_columns(const model::Machine& machine, const model::Measurement& measurement);

/// Returns the factor L of the fit's covariance L L^T for the parameters of a record. The rows of L are 0 for
/// parameters without a covariance in the fit.
Eigen::MatrixXd spread_of_fit(const model::Machine& machine, const std::vector<CheckedQuantity>& quantities,
                              std::size_t parameters);

}  // namespace vernier::check
