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

/// Returns the predicted value of each observation; mm, or deg for rotations. The result of predict() has one
/// entry per observation. Rotation vectors that differ by 360 deg are equivalent. The predicted rotation
/// vector is the equivalent vector that is nearest to the measured vector.
Eigen::VectorXd predict(const Machine& machine, const Measurement& measurement);

/// Predicted readings of a measurement. The unknown values of touched objects (`same`, `on`) have their best
/// estimates for this machine. `known_cost`: weighted sum of squares of the known values of touched objects
/// minus their estimates; 0 if no known value has an uncertainty.
struct Prediction {
  Eigen::VectorXd predicted;
  double known_cost = 0;
};
Prediction predict_with_things(const Machine& machine, const Measurement& measurement);

/// The prediction of all observations and its analytic derivatives by the free parameters: n_obs x n_params,
/// mm or deg per parameter unit.
struct Linearisation {
  Eigen::VectorXd predicted;
  SparseRows jacobian;
  /// Known values of touched objects minus their estimates, and the derivatives of the estimates by the
  /// parameters. The differences and the derivatives are both multiplied by 1/u. The differences
  /// and the derivatives are empty if no known value of a touched object has an uncertainty.
  Eigen::VectorXd known_residual;
  Eigen::MatrixXd known_jacobian;
};
Linearisation linearise(const Machine& machine, const Measurement& measurement,
                        const ParameterSet& parameters);

/// Returns the prediction and its derivatives, like the other linearise(), with a Linearizer that is
/// constructed once. The Linearizer keeps intermediate results that do not depend on the values of
/// the parameters.
class Linearizer;
Linearisation linearise(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                        std::size_t parameters);

/// Derivatives of the observations with the touched objects fixed at their best estimates. `linear`: by the
/// free parameters (n_obs x n_params). `by_unknown`: by the unknown values of all objects (n_obs x unknown
/// values, mm/mm and mm/rad). `precision`: 1/u^2 of each unknown value; 0 if the value is not known at all. A
/// small error that differs from row to row changes the readings by the product with these derivatives. The
/// estimates of the objects are then adapted to this change.
struct HeldLinearisation {
  Linearisation linear;
  Eigen::MatrixXd by_unknown;
  Eigen::VectorXd precision;
};
HeldLinearisation linearise_held(const Machine& machine, const Measurement& measurement,
                                 const ParameterSet& parameters);

/// A touched object (unknown point or artefact) with the best estimates of its unknown values. `own`:
/// covariance of the unknown values for a fixed machine and readings of weight 1/u. `follows`: derivatives of
/// the estimates by the parameters of the machine.
struct EstimatedThing {
  std::size_t thing = 0, touches = 0;
  ThingShape shape;
  Eigen::MatrixXd own, follows;
};
std::vector<EstimatedThing> estimate_things(const Machine& machine, const Measurement& measurement,
                                            const ParameterSet& parameters);

}  // namespace vernier::model
