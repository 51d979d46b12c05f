// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/fit/noise.h"
#include "tools/fit/problem.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Priors that the user states (`--prior`): as if measured at `centre` with 1 / sqrt(weight).
struct StatedPriors {
  Eigen::VectorXd weight, centre;  // 1 / std^2; 0: none
};

/// The one answer that data, stated priors and the convention give, and how well it is known.
struct Settled {
  Eigen::VectorXd point;
  Eigen::VectorXd scale;       // as used: the convention's, lowered to what the machine's own errors are
  Eigen::VectorXd bias;        // what the convention may have moved each parameter by, standard deviation
  Eigen::MatrixXd covariance;  // of data, stated priors and convention, all parameters, times `variance`
  Eigen::MatrixXd open;        // part of it: what no reading bears on, the spread of the scales
  double variance = 1;         // of a weighted reading: chi^2 / freedom, not below 1 where u is given
  double chi_square = 0;       // of the readings alone
  double freedom = 0;          // readings less what was fitted: trace of F (2 - F), F the share from data
  NoiseModel noise;            // how the errors of the readings are correlated: in the covariance
  Eigen::MatrixXd normal;      // J^T W^2 J of the readings and stated priors
  bool converged = false;
  int iterations = 0;
};

/// From `point`, near the minimum, to the answer that depends on nothing but data and convention:
/// minimise chi^2 + variance * sum ((value - centre) / scale)^2, scales of tables lowered to what the
/// determined entries of their kind are (evidence, MacKay 1992), once more from there (iterated Tikhonov, so
/// that what data determine to a fifth of its scale is moved by less than 1 % of its standard deviation), to
/// rounding. `with_u`: weights are 1 / u. noise: how the readings' errors are correlated, for the covariance
/// (the point stays that of independent readings); nothing: estimated from the residual. tool.
Settled settle(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
               const StatedPriors& stated, std::size_t observations, bool with_u,
               const std::optional<NoiseModel>& noise);

/// What settle() would say of a point that another solver found (robust losses): nothing is moved. tool.
Settled describe(FitProblem& problem, const Eigen::VectorXd& point, const Convention& convention,
                 const StatedPriors& stated, std::size_t observations, bool with_u,
                 const std::optional<NoiseModel>& noise);

}  // namespace vernier::fit
