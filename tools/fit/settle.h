// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Priors that the user states (`--prior`). Each prior acts like a measurement at `centre` with the standard
/// uncertainty 1 / sqrt(weight).
struct StatedPriors {
  Eigen::VectorXd weight, centre;  // 1 / std^2; 0: no prior
};

/// The unique result of data, stated priors and the convention, with its uncertainty.
struct Settled {
  Eigen::VectorXd point;
  Eigen::VectorXd scale;       // as used: the convention's, lowered to the size of the machine's own errors
  Eigen::VectorXd bias;        // possible influence of the convention on each parameter, standard deviation
  Eigen::MatrixXd covariance;  // of data, stated priors and convention, all parameters, times `variance`
  Eigen::MatrixXd open;        // part of it: what no reading determines, the spread of the scales
  double variance = 1;         // of a weighted reading: chi^2 / freedom, at least 1 if u is given
  double chi_square = 0;       // of the readings alone
  double freedom = 0;          // readings minus what was fitted: trace of F (2 - F), F the share from data
  NoiseModel noise;            // correlation of the errors of the readings: included in the covariance
  Eigen::MatrixXd normal;      // J^T W^2 J of the readings and stated priors
  /// The last step towards the minimum, in units of each parameter's scale; empty: no step was made.
  Eigen::VectorXd last_step;
  bool converged = false;
  int iterations = 0;
};

/// Moves from `point`, near the minimum, to the result that depends only on data and convention. settle()
/// minimises chi^2 + variance * sum ((value - centre) / scale)^2. Scales of tables are lowered to the size of
/// the determined entries of their kind (evidence, MacKay 1992). A second pass starts from the result
/// (iterated Tikhonov). A value that the data determine to a fifth of its scale then moves by less than 1 %
/// of its standard deviation. The result converges to rounding. `with_u`: weights are 1 / u. noise:
/// correlation of the readings' errors, for the covariance (the point is that of independent readings);
/// nullopt: the correlation is estimated from the residual.
Settled settle(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
               const StatedPriors& stated, std::size_t observations, bool with_u,
               const std::optional<NoiseModel>& noise);

/// Returns the result of settle() without moving the point, for a point that another solver found (robust
/// losses). The point does not move.
Settled describe(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
                 const StatedPriors& stated, std::size_t observations, bool with_u,
                 const std::optional<NoiseModel>& noise);

}  // namespace vernier::fit
