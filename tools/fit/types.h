// SPDX-License-Identifier: GPL-3.0-or-later
// What the units of this room hand to each other: what a fit is asked for, its convention, its result.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/fit/noise.h"
#include "tools/fit/observability.h"
#include "tools/fit/statistics.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

enum class Loss : std::uint8_t { kSquared, kHuber, kCauchy };
enum class Solver : std::uint8_t { kNormalEquations, kCeres };

/// A parameter that is held near its nominal value (its start, where the file gives none): as if it had been
/// measured there with this standard uncertainty.
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
  std::vector<Prior> priors;  // besides the convention's own
  /// How the errors of the readings are correlated, for the uncertainties; nullopt: estimated from the
  /// residual.
  std::optional<NoiseModel> noise;
  /// Called after every iteration with its number and the weighted sum of squares.
  std::function<void(int, double)> progress;
};

/// What a value rests on.
enum class Origin : std::uint8_t {
  kData,        // readings: the convention moves it by less than 1 % of its standard uncertainty
  kConvention,  // it takes part in a combination that the readings do not determine
  kPrior,       // not measured: nominal, give or take its scale
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0;
  double std = 0;    // of data and convention; finite
  double scale = 0;  // how far from nominal it may plausibly be
  Origin from = Origin::kData;
};

/// How the check rows agree with the model's own claim: residual over the uncertainty of reading and model
/// together.
struct NormalisedError {
  double rms = 0;       // 1 where model and uncertainties are right
  double within_3 = 0;  // share of the readings
  std::size_t count = 0;
  /// Standard uncertainty of the square of `rms`, from stretches of rows that follow one another: tails and
  /// correlated errors are in it. Infinite where there are too few of them.
  double square_std = std::numeric_limits<double>::infinity();
};

/// Two estimates that lean on one another.
struct Correlation {
  std::size_t first = 0, second = 0;
  double value = 0;  // -1..1
};

/// Where a fit stood after one of its stages.
struct StageFigures {
  std::string patterns;  // of the parameters freed
  std::size_t parameters = 0;
  int iterations = 0;
  RoleStatistics fit, check;
};

/// Where each parameter stays if the data do not determine it, and how far from there it may plausibly be.
/// This is the convention that makes a fit's answer unique: of all machines that the data cannot tell apart,
/// the one nearest to nominal in these units.
struct Convention {
  /// Kinds below it are of tables; from it on, of statics.
  static constexpr int kFirstOfStatics = 5;
  /// What the nominal machine, set up as well as it can be, leaves of the readings: rms, mm. A machine whose
  /// errors are larger than what was seen of them altogether is not plausible.
  double misfit_mm = 0;
  /// Half the diagonal of the box of the measured points, mm: an angle moves them by that much.
  double reach_mm = 0;
  Eigen::VectorXd centre, scale;  // in the parameters' units
  /// How the values are expected to go together, in units of their scales: neighbours of a table's column
  /// do (0.8 exp(-distance / 2 travels)), others do not. And its inverse.
  Eigen::SparseMatrix<double> correlation, precision;
  std::vector<char> declared;  // the scale is the machine file's own
  std::vector<char> shape;     // a period, a time constant: what stands in a divisor, exponent or lag
  /// Parameters of one kind share what is known of their size, which the fit lowers to what it sees of those
  /// that the data determine: 0 none, else the kind.
  std::vector<int> kind;
  std::vector<int> table;  // which table an entry belongs to; -1: none
  /// Statics that are a slope of an axis' straightness (squareness: k*Z in X): that axis' table, else -1, and
  /// the length at half its travel for one unit, mm.
  std::vector<int> slope_of;
  Eigen::VectorXd slope_mm;
};

/// The reading that stands furthest from the others after a fit.
struct WorstReading {
  double ratio = 0;     // its weighted residual over the spread of all (from their median)
  double share = 0;     // of the sum of squares
  std::string reading;  // "survey.csv:57 z"
};

struct FitResult {
  model::Machine
      machine;  // with the fitted values; a free static without `nominal` has its start value there
  model::ParameterSet parameters;
  std::vector<ParameterEstimate> estimates;
  Observability observability;
  RoleStatistics before, after, check;
  std::optional<double> noise_um;
  NoiseModel noise;  // how the errors of the readings are correlated, as the covariance has it
  double misfit_mm = 0, reach_mm = 0;     // what the scales were made from (tools/fit/convention.h)
  Eigen::MatrixXd covariance;             // of all parameters, convention included
  Eigen::MatrixXd open;                   // part of it: what no reading bears on
  double chi_square = 0;                  // weighted sum of squares at the end
  double freedom = 0;                     // observations less what was fitted of them
  double variance_factor = 1;             // what the covariance was multiplied by
  std::vector<Correlation> correlations;  // above 0.9 in size, largest first
  std::optional<NormalisedError>
      normalised_check;  // where there are check rows and an uncertainty of their readings
  std::vector<std::pair<std::string, double>> priors;  // parameter, standard uncertainty
  std::vector<StageFigures> stages;                    // as asked for, then one of all together
  WorstReading worst, worst_check;                     // of the fit rows; of the check rows
  /// rms that check rows leave of the fitted machine over what they leave of the nominal one, in the set-up
  /// of the fit rows or set up anew, whichever is larger; nothing where there are too few of them.
  std::optional<double> check_ratio;
  /// Why the readings are not those of this machine; empty where they are.
  std::string absurd;
  /// The part of `absurd` that names a mistake of all rows (a unit, a sign, columns swapped); empty where
  /// none was found.
  std::string mistake;
  int iterations = 0;
  bool converged = false;
  Eigen::VectorXd residual;  // measured - model per observation, mm or deg
  /// Variance of the prediction of each reading from the covariance (mm^2, deg^2); empty where no reading has
  /// a freedom left.
  Eigen::VectorXd prediction_variance;
};

}  // namespace vernier::fit
