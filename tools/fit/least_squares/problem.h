// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <utility>
#include <vector>

#include "tools/fit/least_squares/levenberg.h"
#include "tools/model/chain/linearizer.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// A machine with its rows and free parameters as a least-squares problem, in the units of the parameters.
class FitProblem {
 public:
  /// The FitProblem keeps references to `measurement` and `parameters`. The weight of a check row is 0.
  FitProblem(const model::Machine& machine, const model::Measurement& measurement,
             const model::ParameterSet& parameters);

  /// Adds a prior: the parameters stay near `centre`. The cost increases by (value - centre)^T precision
  /// (value - centre).
  void set_priors(const Eigen::SparseMatrix<double>& precision, Eigen::VectorXd centre);
  void clear_priors() { prior_centre_.resize(0); }
  /// Removes the influence of the readings along one direction of the parameters: the size of the whole
  /// machine, if no reading has a known length. Without hold_size(), the noise of the readings would shrink
  /// the machine. direction(point) returns the direction v; `dual` is w, both in the units of the parameters.
  /// After hold_size(), the readings depend only on (I - v w^T / (w^T v)) times the change of the parameters.
  void hold_size(std::function<Eigen::VectorXd(const Eigen::VectorXd&)> direction, Eigen::VectorXd dual);

  /// Removes the influence of the readings on the parameters whose flag is not zero, because only the noise
  /// of the readings would change these parameters. `unseen`: one flag for each parameter; an empty vector
  /// selects no parameter.
  void hold_unseen(std::vector<char> unseen) { unseen_ = std::move(unseen); }

  /// Returns the cost: the sum of squared weighted residuals and of priors. The cost is infinity if
  /// the model is undefined at the given parameter values.
  double cost(const Eigen::VectorXd& point) const;
  /// Returns the normal equations at a point. Throws InputError if the model is undefined at the
  /// given parameter values.
  NormalEquations equations(const Eigen::VectorXd& point) const;
  /// Returns the cost and its gradient at a point, without the normal matrix. The cost is infinity
  /// if the model is undefined at the given parameter values.
  Slope slope(const Eigen::VectorXd& point) const;
  /// Returns J^T W^2 p''. The vector p'' is the second derivative of the predictions along `step`. bend()
  /// evaluates the model once more, at a part of the step. The result of bend() is zero if the model is
  /// undefined at this part of the step.
  Eigen::VectorXd bend(const Eigen::VectorXd& point, const Eigen::VectorXd& step) const;
  /// Returns the weighted residuals (measured - predicted) / u and, if `jacobian` is not null, the weighted
  /// Jacobian of the predictions.
  Eigen::VectorXd weighted_residuals(const Eigen::VectorXd& point, model::SparseRows* jacobian) const;

  /// Returns the weighted derivatives of the readings by the unknown values of touched objects. Only values
  /// that the readings determine better than their prior knowledge are included. The matrix of
  /// derivatives is 0 x 0 if there are no touched objects.
  Eigen::MatrixXd things_jacobian(const Eigen::VectorXd& point) const;
  /// Returns the derivatives of the known values of touched objects by the parameters, times 1/u; 0 x 0 if no
  /// value is known.
  Eigen::MatrixXd known_jacobian(const Eigen::VectorXd& point) const;
  /// Returns the contribution of known values of touched objects (a radius or a position with an uncertainty)
  /// to the normal equations; 0 x 0 if no value is known.
  Eigen::MatrixXd known_normal(const Eigen::VectorXd& point) const;

  const Eigen::SparseMatrix<double>& prior_precision() const { return prior_precision_; }
  const Eigen::VectorXd& prior_centre() const { return prior_centre_; }  // empty if there are no priors
  const model::Measurement& measurement() const { return measurement_; }
  const model::Things& things() const { return linearizer_.things(); }
  const Eigen::VectorXd& weights() const { return weights_; }  // weights of the readings
  /// Multiplies the weight of every reading by its factor in `shares`.
  void weigh(const Eigen::VectorXd& shares) { weights_ = weights_.cwiseProduct(shares); }

 private:
  model::Machine at(const Eigen::VectorXd& point) const;
  double prior_cost(const Eigen::VectorXd& point) const;
  NormalEquations readings_with_things(const Eigen::VectorXd& point) const;
  Eigen::VectorXd bend_with_things(const Eigen::VectorXd& point, const Eigen::VectorXd& step,
                                   const Eigen::VectorXd& ahead, double part) const;
  model::Linearisation linearised(const Eigen::VectorXd& point) const;
  void blind(const Eigen::VectorXd& point, NormalEquations& equations) const;
  void blind(const Eigen::VectorXd& point, Eigen::VectorXd& gradient) const;
  bool is_unseen(Eigen::Index i) const {
    return !unseen_.empty() && unseen_[static_cast<std::size_t>(i)] != 0;
  }

  model::Machine machine_;
  const model::Measurement& measurement_;
  const model::ParameterSet& parameters_;
  model::Linearizer linearizer_;
  Eigen::VectorXd weights_, measured_;
  Eigen::SparseMatrix<double> prior_precision_;
  Eigen::VectorXd prior_centre_;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> size_;
  Eigen::VectorXd size_dual_;
  std::vector<char> unseen_;
};

}  // namespace vernier::fit
