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

#include "tools/fit/least_squares/observability.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

enum class Loss : std::uint8_t { kSquared, kHuber, kCauchy };
enum class Solver : std::uint8_t { kNormalEquations, kCeres };

/// A parameter with a prior at its nominal value (at its start value, if the file has no nominal). A Prior
/// acts like a measurement of the nominal value with this standard uncertainty.
struct Prior {
  std::string pattern;  // name, with * and ? as in file names
  double std = 0;       // in the parameter's unit
};

struct FitOptions {
  Loss loss = Loss::kSquared;
  double loss_scale = 3;  // in units of u (of the residual's standard deviation if u is absent)
  Solver solver = Solver::kNormalEquations;
  int max_iterations = 100;
  /// Stages that are fitted one after another before all parameters are fitted together. A stage is a list of
  /// patterns of the parameters freed in it.
  std::vector<std::vector<std::string>> stages;
  std::vector<Prior> priors;  // in addition to the convention's own
  /// Correlation of the errors of the readings, for the uncertainties; nullopt: estimated from the
  /// residual.
  std::optional<NoiseModel> noise;
  /// The fit calls `progress` after every iteration with the number of the iteration and the weighted sum of
  /// squares.
  std::function<void(int, double)> progress;
};

/// The source of a value.
enum class Origin : std::uint8_t {
  kData,        // readings: the convention moves it by less than 1 % of its standard uncertainty
  kConvention,  // the parameter is part of a combination that the readings do not determine
  kPrior,       // not measured: nominal ± its scale
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0;
  double std = 0;    // of data and convention; finite
  double scale = 0;  // plausible difference from nominal
  Origin from = Origin::kData;
};

/// Agreement of the check rows with the stated uncertainty: residual divided by the uncertainty of
/// reading and model together.
struct NormalisedError {
  double rms = 0;       // 1 if model and uncertainties are right
  double within_3 = 0;  // share of the readings
  std::size_t count = 0;
  /// Standard uncertainty of the square of `rms`, from blocks of successive rows. square_std includes tails
  /// and correlated errors. square_std is infinite if there are too few blocks.
  double square_std = std::numeric_limits<double>::infinity();
};

/// Two parameters whose estimates are correlated.
struct Correlation {
  std::size_t first = 0, second = 0;
  double value = 0;  // -1..1
};

/// Statistics of a fit after one of its stages.
struct StageFigures {
  std::string patterns;  // of the parameters freed
  std::size_t parameters = 0;
  int iterations = 0;
  RoleStatistics fit, check;
};

/// Value of each parameter if the data do not determine it, and its plausible difference from this value. The
/// convention makes the result of a fit unique. Among all machines that the data cannot distinguish, the fit
/// selects the machine nearest to nominal in these units.
struct Convention {
  /// Smaller kinds are of tables. The first kind of statics: this kind and larger kinds are statics.
  static constexpr int kFirstOfStatics = 5;
  /// Residual of the nominal machine with the best set-up: rms, mm. A machine whose errors exceed misfit_mm
  /// in total is not plausible.
  double misfit_mm = 0;
  /// Half the diagonal of the box of the measured points, mm. An angle moves the points by the lever
  /// reach_mm.
  double reach_mm = 0;
  Eigen::VectorXd centre, scale;  // in the parameters' units
  /// Expected correlation of the values, in units of their scales. Neighbours of a table's column are
  /// correlated (0.8 exp(-distance / 2 travels)); other values are independent. `precision` is the inverse of
  /// `correlation`.
  Eigen::SparseMatrix<double> correlation, precision;
  std::vector<char> declared;  // the machine file declares the scale
  std::vector<char> shape;     // a period or a time constant: in a divisor, exponent or lag
  /// Parameters of one kind share the information about their size. The fit lowers the scale of a kind to the
  /// size of the parameters that the data determine. 0: the parameter has no kind; else the number of its
  /// kind.
  std::vector<int> kind;
  std::vector<int> table;  // table of an entry; -1: no table
  /// Statics that are a slope of an axis' straightness (squareness: k*Z in X). slope_of: the table of that
  /// axis, else -1; the second list: the length at half its travel for one unit, mm.
  std::vector<int> slope_of;
  Eigen::VectorXd slope_mm;
  /// Rows that touch objects: upper limit of each scale, in the parameters' units; else empty.
  Eigen::VectorXd most;
  /// Parameters that no reading shows: touched objects follow them, and what is left is noise. Empty without
  /// such rows.
  std::vector<char> unseen;
  std::vector<bool> unseen_turn;  // rotation of a set-up that the readings show in second order only
};

/// The reading with the largest residual after a fit.
struct WorstReading {
  double ratio = 0;     // its weighted residual divided by the spread of all (from their median)
  double share = 0;     // of the sum of squares
  std::string reading;  // "survey.csv:57 z"
};

/// Position, direction and radius of a touched object (`same`, `on`).
struct ThingEstimate {
  std::string name, setup, type;    // type: `same`, or the type of the artefact
  bool in_measuring_frame = false;  // else in workpiece coordinates
  std::size_t touches = 0;          // rows of the fit
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero(), u_place_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> direction;
  double u_direction_deg = 0;
  std::optional<double> radius_mm;
  double u_radius_mm = 0;
};

/// The lengths that determine the size of the machine.
struct SizeOfMachine {
  bool known = false;       // false: held at nominal
  bool has_length = false;  // of a size at nominal: there are known lengths, and they do not determine it
  double relative_std = 0;  // standard uncertainty of the size, as a share; of nominal: the plausible share
  std::string from;         // "distances", "known radius", "board", "machine", "nominal" ...
  /// Lengths that the fit does not change and that limit the size of the machine: names of constants, scales
  /// of axes. Empty if the fit can change the size as a whole.
  std::vector<std::string> fixed;
};

struct FitResult {
  model::Machine
      machine;  // with the fitted values; a free static without `nominal` has its start value there
  model::ParameterSet parameters;
  std::vector<ParameterEstimate> estimates;
  Observability observability;
  RoleStatistics before, after, check;
  std::optional<double> noise_um;
  NoiseModel noise;                    // correlation of the errors of the readings, as the covariance uses it
  double misfit_mm = 0, reach_mm = 0;  // basis of the scales (tools/fit/convention.h)
  Eigen::MatrixXd covariance;          // of all parameters, including the convention
  Eigen::MatrixXd open;                // part of it: what no reading determines
  double chi_square = 0;               // weighted sum of squares at the end
  double freedom = 0;                  // observations minus the number of fitted parameters
  double variance_factor = 1;          // factor by which the covariance was multiplied
  std::vector<Correlation> correlations;  // above 0.9 in magnitude, largest first
  std::optional<NormalisedError>
      normalised_check;  // if there are check rows with an uncertainty of their readings
  std::vector<std::pair<std::string, double>> priors;  // parameter, standard uncertainty
  std::vector<ThingEstimate> things;                   // that rows met
  std::optional<SizeOfMachine> size;                   // if rows met things or a board
  std::vector<StageFigures> stages;                    // as requested, then one with all parameters
  WorstReading worst, worst_check;                     // of the fit rows; of the check rows
  /// rms of the fitted machine on check rows, divided by the rms of the nominal machine. The fitted machine
  /// and the nominal machine both use the set-up of the fit rows. If there are enough check rows, a second
  /// ratio uses a set-up of each machine that is fitted to the check rows. check_ratio is the larger of the
  /// first and the second ratio; nullopt if there are too few check rows.
  std::optional<double> check_ratio;
  /// Reason why the readings cannot be readings of this machine; empty if there is no such reason.
  std::string absurd;
  /// The part of `absurd` that names a mistake of all rows (a unit, a sign, columns swapped);
  /// empty if no such mistake was found.
  std::string mistake;
  int iterations = 0;
  bool converged = false;
  Eigen::VectorXd residual;  // measured - model per observation, mm or deg
  /// Variance of the prediction of each reading from the covariance (mm^2, deg^2); empty if no
  /// degree of freedom remains.
  Eigen::VectorXd prediction_variance;
};

}  // namespace vernier::fit
