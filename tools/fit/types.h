// SPDX-License-Identifier: GPL-3.0-or-later
// Types that the source files of tools/fit have in common: the options of a fit, its convention and its
// result.
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

#include "tools/fit/least_squares/file_factors.h"
#include "tools/fit/least_squares/observability.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

enum class Loss : std::uint8_t { kSquared, kHuber, kCauchy };
enum class Solver : std::uint8_t { kNormalEquations, kCeres };

/// A prior at the nominal value of a parameter. If the machine file has no nominal value for a parameter,
/// the prior is at the start value. A Prior acts like a measurement of the nominal value with the standard
/// uncertainty `std`.
struct Prior {
  std::string pattern;  // name of the parameters, with * and ? as in file names
  double std = 0;       // standard uncertainty, in the unit of the parameter
};

struct FitOptions {
  Loss loss = Loss::kSquared;
  double loss_scale = 3;  // in units of u; if u is absent, in units of the standard deviation of the residual
  Solver solver = Solver::kNormalEquations;
  int max_iterations = 100;
  /// Stages of the fit, one after another, before all parameters are fitted together. A stage is a list of
  /// patterns that select the free parameters of this stage.
  std::vector<std::vector<std::string>> stages;
  std::vector<Prior> priors;  // priors in addition to the priors of the convention
  /// Noise model (correlation of the errors of the readings) for the uncertainties; nullopt: the noise model
  /// is estimated from the residual.
  std::optional<NoiseModel> noise;
  /// The fit calls `progress` after every iteration, with the number of the iteration and the weighted sum of
  /// squares.
  std::function<void(int, double)> progress;
};

/// The source of a parameter's value.
enum class Origin : std::uint8_t {
  kData,        // the readings determine the value; the convention moves it by less than 1 % of its standard
                // uncertainty
  kConvention,  // the parameter is part of a combination that the readings do not determine
  kPrior,       // the parameter is not measured or hardly measured; its uncertainty is that of its scale
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0;
  double std = 0;    // standard uncertainty from data and convention; always finite
  double scale = 0;  // plausible difference of the value from nominal
  Origin from = Origin::kData;
  double nominal = 0;  // value of the parameter if no reading determined it
  /// True if the readings changed the value, although its uncertainty is still that of its scale.
  bool moved() const;
};

/// Agreement of the check rows with the stated uncertainty. The normalised error of a reading is its residual
/// divided by the uncertainty of reading and model together.
struct NormalisedError {
  double rms = 0;       // rms of the normalised errors; 1 if model and uncertainties are right
  double within_3 = 0;  // share of the readings with a normalised error up to 3
  std::size_t count = 0;
  /// Standard uncertainty of the square of `rms`, from blocks of successive rows. The value square_std
  /// includes the influence of outliers and correlated errors. The value square_std is infinite if there are
  /// too few blocks.
  double square_std = std::numeric_limits<double>::infinity();
};

/// Two parameters whose estimates are correlated, and their correlation coefficient.
struct Correlation {
  std::size_t first = 0, second = 0;
  double value = 0;  // -1..1
};

/// Statistics of a fit after one of its stages.
struct StageFigures {
  std::string patterns;  // patterns of the parameters that this stage freed
  std::size_t parameters = 0;
  int iterations = 0;
  RoleStatistics fit, check;
};

/// The convention of a fit: the value of each parameter if the data do not determine it, and its plausible
/// difference from this value. The convention makes the result of a fit unique. Among all machines that the
/// data cannot distinguish, the fit selects the machine that is nearest to nominal in units of the scales.
struct Convention {
  /// Number of the first parameter kind that consists of statics. Parameter kinds with smaller numbers are
  /// kinds of table entries.
  static constexpr int kFirstOfStatics = 5;
  /// Residual of the nominal machine with the best set-up: rms, mm. If the errors of a machine exceed
  /// misfit_mm in total, the machine is not plausible.
  double misfit_mm = 0;
  /// Half the diagonal of the box around the measured points, mm. An angle error moves the points by the
  /// angle times the length reach_mm.
  double reach_mm = 0;
  Eigen::VectorXd centre, scale;  // in the parameters' units
  /// Expected correlation of the parameter values, in units of their scales. Neighbouring values in the
  /// column of a table are correlated (0.8 exp(-distance / 2 travels)). Other values are independent.
  /// `precision` is the inverse of `correlation`.
  Eigen::SparseMatrix<double> correlation, precision;
  std::vector<char> declared;  // true: the machine file states the scale of the parameter
  std::vector<char> shape;     // true: the parameter is a period or a time constant (in a divisor, exponent
                               // or lag)
  /// The parameters of one kind have a common size of their errors. The fit reduces the scale of a kind to
  /// the size of those parameters that the data determine. `kind`: number of the kind of each parameter; 0:
  /// the parameter has no kind.
  std::vector<int> kind;
  std::vector<int> table;  // table of each parameter; -1: no table
  /// Statics that are a slope in the straightness of an axis (squareness: k*Z in X). `slope_of`: index of
  /// that axis' table; -1 for other parameters. `slope_mm`: straightness at half the travel of the axis for a
  /// value 1 of the static, mm.
  std::vector<int> slope_of;
  Eigen::VectorXd slope_mm;
  /// Upper limit of each scale if the rows touch objects, in the units of the parameters; empty if no rows
  /// touch objects.
  Eigen::VectorXd most;
  /// Flags of the parameters that no reading shows, because the fitted values of the touched objects explain
  /// their effect. The remaining effect is noise. `unseen` is empty if no rows touch objects.
  std::vector<char> unseen;
  /// True for the entries of a table whose axis hardly moved while objects were touched:
  /// they are unseen, whatever the fitted machine is. Empty if no rows touch objects.
  std::vector<char> still;
  std::vector<bool> unseen_turn;  // true: rotation of a set-up that affects the readings only in second order
};

/// The reading with the largest residual after a fit.
struct WorstReading {
  double ratio = 0;     // weighted residual of the reading divided by the standard deviation of all residuals
                        // (from their median)
  double share = 0;     // share of this reading in the sum of squares
  std::string reading;  // name of the reading: "survey.csv:57 z"
};

/// Position, direction and radius of a touched object (`same`, `on`).
struct ThingEstimate {
  std::string name, setup, type;    // `type`: `same`, or the type of the artefact
  bool in_measuring_frame = false;  // true: in the measuring frame; false: in workpiece coordinates
  std::size_t touches = 0;          // number of fit rows that touch the object
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero(), u_place_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> direction;
  double u_direction_deg = 0;
  std::optional<double> radius_mm;
  double u_radius_mm = 0;
};

/// The lengths that determine the size of the machine.
struct SizeOfMachine {
  bool known = false;       // false: the size is fixed at nominal
  bool has_length = false;  // for a size at nominal: true if there are known lengths that do not determine
                            // the size
  double relative_std = 0;  // relative standard uncertainty of the size; for a size at nominal, the plausible
                            // relative difference
  std::string from;         // source of the size: "distances", "known radius", "board", "machine", "nominal"
                            // ...
  /// Names of the lengths that limit the size of the machine and that the fit does not change: constants,
  /// scales of axes. `fixed` is empty if the fit can change the size of the machine as a whole.
  std::vector<std::string> fixed;
};

struct FitResult {
  model::Machine machine;  // machine with the fitted values; the `nominal` of a free static without one is
                           // its start value
  model::ParameterSet parameters;
  std::vector<ParameterEstimate> estimates;
  Observability observability;
  RoleStatistics before, after, check;
  /// Fit rows of the given machine, with a fitted set-up; nullopt if no set-up is free. `before` has the
  /// set-up of the machine file, which may be metres from the instrument.
  std::optional<RoleStatistics> only_set_up;
  std::optional<double> noise_um;
  NoiseModel noise;                    // noise model (correlation of the errors of the readings) that the
                                       // covariance uses
  double misfit_mm = 0, reach_mm = 0;  // misfit and reach, from which the scales are computed
                                       // (tools/fit/convention.h)
  Eigen::MatrixXd covariance;          // covariance of all parameters, including the convention
  Eigen::MatrixXd open;                // part of the covariance from parameters that no reading determines
  double chi_square = 0;               // weighted sum of squares at the end of the fit
  double freedom = 0;                  // observations minus the number of fitted parameters
  double variance_factor = 1;          // factor that multiplies the covariance
  /// Factors of u in the fit if the files differ in how far the model describes them; empty: 1 for all.
  /// `chi_square` is the sum of squares over the stated u; `variance_factor` that over u times the factors,
  /// divided by `freedom`.
  std::vector<FileFactor> file_factors;
  /// Returns the factor of u of a file.
  double factor_of(std::size_t file) const;
  std::vector<Correlation> correlations;  // correlations above 0.9 in magnitude, largest first
  std::optional<NormalisedError>
      normalised_check;  // no value without check rows, or if no degree of freedom remains
  std::vector<std::pair<std::string, double>> priors;  // name of a parameter and the standard uncertainty of
                                                       // its prior
  std::vector<ThingEstimate> things;                   // objects that the rows touch
  std::optional<SizeOfMachine> size;                   // no value if the rows have no touched objects and no
                                                       // board
  std::vector<StageFigures> stages;                    // the stages as requested, then one stage with all
                                                       // parameters
  WorstReading worst, worst_check;                     // worst: of the fit rows; worst_check: of the check
                                                       // rows
  /// Ratio of two rms residuals on the check rows: fitted machine divided by nominal machine. For the first
  /// ratio of rms residuals, the fitted and the nominal machine use the set-up of the fit rows. If there are
  /// enough check rows, a second ratio uses a set-up of each machine that is fitted to the check rows. The
  /// result check_ratio is the larger of both ratios; nullopt if there are too few check rows.
  std::optional<double> check_ratio;
  /// Reason why the readings do not belong to this machine; empty if there is no such reason.
  std::string absurd;
  /// The part of `absurd` that names a mistake of all rows (a wrong unit, a wrong sign, swapped columns);
  /// empty if no such mistake was found.
  std::string mistake;
  int iterations = 0;
  bool converged = false;
  Eigen::VectorXd residual;  // measured - model of each observation, mm or deg
  /// Variance of the predicted value of each reading, from the covariance of the parameters (mm^2, deg^2);
  /// empty if no degree of freedom remains.
  Eigen::VectorXd prediction_variance;
};

}  // namespace vernier::fit
