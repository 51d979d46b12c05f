// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "tools/model/chain/thing_shape.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::model {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Returns the predicted value of each observation; mm, or deg for rotations. The result has one entry per
/// observation. Rotation vectors repeat every 360 deg. The predicted rotation vector is the equivalent vector
/// nearest to the measured vector.
Eigen::VectorXd predict(const Machine& machine, const Measurement& measurement);

/// Touched objects (`same`, `on`) have the best estimates of their unknown values for this machine.
/// `known_cost`: weighted sum of squares of their known values about these estimates; 0 without an uncertain
/// known value.
struct Prediction {
  Eigen::VectorXd predicted;
  double known_cost = 0;
};
Prediction predict_with_things(const Machine& machine, const Measurement& measurement);

/// The prediction and its derivatives by the free parameters (analytic): n_obs x n_params, mm or
/// deg per parameter unit.
struct Linearisation {
  Eigen::VectorXd predicted;
  SparseRows jacobian;
  /// Known values of touched objects minus their estimates, times 1/u, and the derivatives of the estimates
  /// by the parameters, times 1/u. Empty without an uncertain known value.
  Eigen::VectorXd known_residual;
  Eigen::MatrixXd known_jacobian;
};
Linearisation linearise(const Machine& machine, const Measurement& measurement,
                        const ParameterSet& parameters);

/// Returns the prediction and its derivatives, like linearise(), with a Linearizer that is made once. The
/// work that does not depend on the parameters' values is done beforehand.
class Linearizer;
Linearisation linearise(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                        std::size_t parameters);

/// The derivatives with touched objects held at their best estimates: by the free parameters (n_obs x
/// n_params), and by the unknown values of all objects (n_obs x unknown values, mm/mm and mm/rad).
/// `precision`: 1/u^2 of each unknown value, 0 if nothing is known of it. A change of the readings that
/// differs from row to row is the product with these derivatives; afterwards the objects follow it.
struct HeldLinearisation {
  Linearisation linear;
  Eigen::MatrixXd by_unknown;
  Eigen::VectorXd precision;
};
HeldLinearisation linearise_held(const Machine& machine, const Measurement& measurement,
                                 const ParameterSet& parameters);

/// A touched object (unknown point or artefact) with the best estimates of its unknown values. `own`:
/// covariance of the unknown values for a fixed machine and readings of weight 1/u; `follows`: derivatives of
/// the unknown values by the parameters.
struct EstimatedThing {
  std::size_t thing = 0, touches = 0;
  ThingShape shape;
  Eigen::MatrixXd own, follows;
};
std::vector<EstimatedThing> estimate_things(const Machine& machine, const Measurement& measurement,
                                            const ParameterSet& parameters);

}  // namespace vernier::model
