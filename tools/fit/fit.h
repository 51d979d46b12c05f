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

/// A parameter that is held near its start: as if it had been measured there with this standard uncertainty.
struct Prior {
  std::string pattern;  // name, with * and ? as in file names
  double std = 0;       // in the parameter's unit
};

struct FitOptions {
  Loss loss = Loss::kSquared;
  double loss_scale = 3;  // in units of u (of the residual's spread where u is absent)
  Solver solver = Solver::kNormalEquations;
  int max_iterations = 100;
  /// Fitted one after the other before everything is fitted together: patterns of the parameters freed in
  /// each stage.
  std::vector<std::vector<std::string>> stages;
  std::vector<Prior> priors;  // none: nothing is regularised
  /// Called after every iteration with its number and the weighted sum of squares.
  std::function<void(int, double)> progress;
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0;
  std::optional<double> std;  // nothing where the data do not determine it
};

/// How the check rows agree with the model's own claim: residual over the uncertainty of reading and model
/// together.
struct NormalisedError {
  double rms = 0;       // 1 where model and uncertainties are right
  double within_3 = 0;  // share of the readings
  std::size_t count = 0;
};

/// Two estimates that lean on one another.
struct Correlation {
  std::size_t first = 0, second = 0;
  double value = 0;  // -1..1
};

struct FitResult {
  Machine machine;  // with the fitted values
  ParameterSet parameters;
  std::vector<ParameterEstimate> estimates;
  Observability observability;
  RoleStatistics before, after, check;
  std::optional<double> noise_um;
  double chi_square = 0;                  // weighted sum of squares at the end
  Eigen::Index freedom = 0;               // observations - rank
  double variance_factor = 1;             // what the covariance was multiplied by
  std::vector<Correlation> correlations;  // above 0.9 in size, largest first
  std::optional<NormalisedError>
      normalised_check;  // where there are check rows and an uncertainty of their readings
  std::vector<std::pair<std::string, double>> priors;  // parameter, standard uncertainty
  std::vector<char> held;  // parameters that stand for directions left at their start; empty: none
  int iterations = 0;
  bool converged = false;
  Eigen::VectorXd residual;  // measured - model per observation, mm or deg
};

/// Weighted least squares on the fit rows: residual / u (1 where u is absent). Free parameters that the data
/// cannot separate keep their start along the unidentified directions and are named in `observability`. So do
/// directions that the data do not see at the start and only faintly, through products of errors, at the end,
/// while following them promises no more than chance would, or would turn something by more than half a
/// degree. Set-ups that start more than 0.1 deg off are aligned first. Standard uncertainty: from u, times
/// sqrt(chi^2 / dof) where that exceeds 1; without u from the residual (GUM 5.2). Throws InputError where
/// there is nothing to fit. tool.
FitResult fit(const Machine& machine, const Measurement& measurement, const FitOptions& options = {});

/// residual = measured - predicted.
Eigen::VectorXd residuals(const Machine& machine, const Measurement& measurement);

}  // namespace vernier
