// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Priors of the parameters that the user states (`--prior`). Each stated prior acts like a measurement of
/// the value `centre` with the standard uncertainty 1 / sqrt(weight).
struct StatedPriors {
  Eigen::VectorXd weight, centre;  // weight: 1 / std^2; 0: no prior
};

/// The unique result of a fit, with its uncertainty. The readings, the stated priors and the convention
/// together determine the result.
struct Settled {
  Eigen::VectorXd point;
  Eigen::VectorXd scale;       // scales that the fit used: those of the convention, reduced to the size of
                               // the machine's own errors
  Eigen::VectorXd bias;        // possible influence of the convention on each parameter, as a standard
                               // deviation
  Eigen::MatrixXd covariance;  // covariance of all parameters from data, stated priors and convention,
                               // multiplied by `variance`
  Eigen::MatrixXd open;        // part of the covariance from parameters that no reading determines: the
                               // variance of their scales
  double variance = 1;         // variance of a weighted reading: chi^2 / freedom, at least 1 if u is given
  double chi_square = 0;       // chi^2 of the readings alone, without priors
  double freedom = 0;          // degrees of freedom: readings minus trace of F (2 - F), F being the share
                               // that comes from data
  NoiseModel noise;            // noise model (correlation of the errors of the readings), which the
                               // covariance includes
  Eigen::MatrixXd normal;      // normal matrix J^T W^2 J of the readings and the stated priors
  /// The last step towards the minimum, in units of each parameter's scale; empty if no step was made.
  Eigen::VectorXd last_step;
  bool converged = false;
  int iterations = 0;
};

/// Computes the result of a fit that depends only on data and convention, from a start `point` near the
/// minimum. settle() minimises chi^2 + variance * sum ((value - centre) / scale)^2. The scales of tables are
/// reduced to the size of those entries of their kind that the data determine (evidence, MacKay 1992). A
/// second pass of settle() starts from the result of the first pass (iterated Tikhonov). If the data
/// determine a value to a fifth of its scale, the second pass moves this value by less than 1 % of its
/// standard deviation. The fitted result converges to the rounding error. `with_u`: true if the weights of
/// the readings are 1 / u. `noise`: noise model for the covariance; nullopt: the noise model is estimated
/// from the residual. The fitted parameter values are computed for independent readings. `of_files`: true if
/// the readings are of several files. The correlation of the errors can be that of one of them, so no
/// standard uncertainty is then below that of independent readings.
Settled settle(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
               const StatedPriors& stated, std::size_t observations, bool with_u,
               const std::optional<NoiseModel>& noise, bool of_files);

/// Returns the result of settle() for a point that another solver found (robust losses). describe() does not
/// move this point.
Settled describe(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
                 const StatedPriors& stated, std::size_t observations, bool with_u,
                 const std::optional<NoiseModel>& noise);

}  // namespace vernier::fit
