#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/fit/observability.h"
#include "tools/fit/statistics.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier {

enum class Loss : std::uint8_t { kSquared, kHuber, kCauchy };
enum class Solver : std::uint8_t { kNormalEquations, kCeres };

struct FitOptions {
  Loss loss = Loss::kSquared;
  double loss_scale = 3;  // in units of u (of the residual's spread where u is absent)
  Solver solver = Solver::kNormalEquations;
  int max_iterations = 100;
  /// Called after every iteration with its number and the weighted sum of squares.
  std::function<void(int, double)> progress;
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0;
  std::optional<double> std;  // nothing where the data do not determine it
};

struct FitResult {
  Machine machine;  // with the fitted values
  ParameterSet parameters;
  std::vector<ParameterEstimate> estimates;
  Observability observability;
  RoleStatistics before, after, check;
  std::optional<double> noise_um;
  double chi_square = 0;       // weighted sum of squares at the end
  Eigen::Index freedom = 0;    // observations - rank
  double variance_factor = 1;  // what the covariance was multiplied by
  int iterations = 0;
  bool converged = false;
  Eigen::VectorXd residual;  // measured - model per observation, mm or deg
};

/// Weighted least squares on the fit rows: residual / u (1 where u is absent). Free parameters that the data
/// cannot separate keep their start along the unidentified directions and are named in `observability`.
/// Standard uncertainty: from u, times sqrt(chi^2 / dof) where that exceeds 1; without u from the residual
/// (GUM 5.2). Throws InputError where there is nothing to fit. tool.
FitResult fit(const Machine& machine, const Measurement& measurement, const FitOptions& options = {});

/// residual = measured - predicted.
Eigen::VectorXd residuals(const Machine& machine, const Measurement& measurement);

}  // namespace vernier
