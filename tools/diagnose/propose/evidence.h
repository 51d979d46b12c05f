// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/effects/candidate.h"
#include "tools/fit/fit.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// The data that a search for effects needs, from a fitted machine and its rows. The data are the influence
/// of each degree of freedom on each observation, the residual, and the columns of the free parameters of the
/// model.
class Evidence {
 public:
  /// `fitted`: the machine at its best fit. Every logged column of the measurement becomes an input of the
  /// machine.
  Evidence(const model::Machine& fitted, const model::Measurement& measurement,
           const DiagnoseThresholds& thresholds = {});

  /// Returns the thresholds for all parts of the search.
  const DiagnoseThresholds& thresholds() const { return thresholds_; }
  /// Returns the machine. Every logged column is an input of this machine.
  const model::Machine& machine() const { return machine_; }
  const model::Measurement& measurement() const { return measurement_; }
  /// Returns the reference value of an input: the declared reference; else 20 degC for a temperature; else a
  /// round number near the mean of the input.
  double reference_of(std::size_t input) const;
  const std::vector<effects::DofPlace>& places() const { return places_; }
  std::size_t index_of(const effects::DofPlace& place) const;

  /// Returns the response of the fit observations to a motion at a location of the chain: d reading / d
  /// motion (motion in mm or deg), weighted by 1/u.
  auto response(std::size_t place) const { return response_.col(static_cast<Eigen::Index>(place)); }
  /// Returns the row of each fit observation.
  const std::vector<std::size_t>& rows() const { return rows_; }
  /// Returns the rows that have a fit observation, in increasing order.
  const std::vector<std::size_t>& fit_rows() const { return fit_rows_; }
  /// Returns, for each row of fit_rows(), the sum over its fit observations of the response to a motion at a
  /// location, times the entries of `columns` (one row for each fit observation).
  Eigen::MatrixXd sums_by_row(std::size_t place, const Eigen::MatrixXd& columns) const;
  /// Returns columns before whitening from the terms of a candidate, given as functions of the fit rows: for
  /// each term a matrix with one row for each row of fit_rows().
  Eigen::MatrixXd at_observations(const effects::Candidate& candidate,
                                  const std::vector<Eigen::MatrixXd>& of_term) const;
  /// Returns the values of a column of the measurement in the row of each fit observation.
  Eigen::ArrayXd at_readings(const model::Column& column) const;
  /// Returns the commanded position of an axis in each row of the measurement. A commanded position excludes
  /// the correction. If the correction were included, every reading would be a separate pose.
  const model::Column& position(std::size_t axis) const { return position_[axis]; }
  const Eigen::VectorXd& weights() const { return weight_; }
  /// Returns the weighted residual (measured - model) / u of the fit observations, without the part that the
  /// free parameters of the model can explain.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// Returns orthonormal columns that span the changes of the readings by the free parameters of the model.
  const Eigen::MatrixXd& absorbed() const { return absorbed_; }
  /// Returns whitened columns without the part that the free parameters of the model explain.
  Eigen::MatrixXd beside_model(const Eigen::MatrixXd& columns) const {
    return columns - absorbed_ * (absorbed_.transpose() * columns);
  }
  bool noise_known() const { return noise_known_; }
  double chi_square() const { return residual_.squaredNorm(); }
  double freedom() const { return static_cast<double>(residual_.size() - absorbed_.cols()); }

  /// Returns the columns of a candidate before whitening, one column for each linear unknown: weighted
  /// readings per unit of the unknown. `scanned`: values of the unknowns that are not linear, in their order.
  Eigen::MatrixXd columns(const effects::Candidate& candidate, const std::vector<double>& scanned) const;

  /// Returns the index of a block for each fit observation, for leave-one-out tests. The blocks are the runs
  /// of the fit rows. If the fit rows have only one run, the blocks are groups of successive rows.
  const std::vector<int>& blocks() const { return block_; }
  /// Returns smaller blocks than blocks(): every run is divided into parts that are held out in turn.
  std::vector<int> parts_of_runs() const;

  /// Returns a ratio of variances: the error that readings of one kind at one pose have in common, over their
  /// independent error (one-way analysis of variance, Searle 1992, 3.6). The ratio is 0 if no pose was read
  /// more than once, or if the ratio is not significant. `residual`: residual of the model with the
  /// orthonormal columns `fitted`.
  double shared_pose_error(const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted) const;
  /// Assumes from this call on that the readings at one pose have a common error. The variance of this common
  /// error is `share` times the independent variance of the readings (generalised least squares). The
  /// function weigh_poses weights the residual, the columns and the part that the free parameters of the
  /// model explain.
  void weigh_poses(double share);
  /// True if u is given and few poses are visited twice. If few poses are visited twice, the noise model
  /// describes the common error of the readings of a dwell (NoiseModel::pose), even if u includes this error.
  bool poses_are_visits() const;
  /// Assumes from this call on that the noise model `noise` gives the correlation of the readings' errors
  /// (generalised least squares). assume() whitens the residual, the columns and the columns of the model's
  /// free parameters.
  void assume(const fit::NoiseModel& noise);
  const fit::NoiseModel& noise() const { return noise_; }
  /// True if whitening divides every observation by noise().own, and does nothing else.
  bool observations_are_independent() const { return noise_.independent() && pose_share_ == 0; }
  /// Returns a counter that increases each time the whitening changes.
  std::size_t revision() const { return revision_; }
  /// Returns the logarithm of the determinant of the covariance of the readings under the noise model
  /// noise().
  double log_determinant() const { return log_determinant_; }
  /// Returns an estimate of the noise model (correlation of the readings' errors) from the residual of the
  /// model with the columns `raw`. `given`: steps of the instrument that are assumed. The heights of the
  /// given steps are estimated together with the model and the columns `raw`.
  fit::NoiseModel estimate(const Eigen::MatrixXd& raw, std::vector<fit::NoiseStep> given = {}) const;
  const fit::NoiseLayout& layout() const { return layout_; }
  /// Returns the sum of squares of the weighted residual, before whitening, after a fit of the model and the
  /// columns `raw`.
  double left_in_full(const Eigen::MatrixXd& raw) const;
  /// Returns the columns of a candidate before any whitening.
  Eigen::MatrixXd raw_columns(const effects::Candidate& candidate, const std::vector<double>& scanned) const;
  /// Returns one column for each kind of reading, before whitening: the influence of one common offset of
  /// this kind.
  Eigen::MatrixXd offset_columns() const;
  /// Returns the noise model for all rows of the file, also if only every k-th row is used in this Evidence.
  fit::NoiseModel noise_of_file() const;
  /// Whitens columns over the fit observations with the noise model noise().
  void whiten(Eigen::MatrixXd& columns) const;
  /// Multiplies columns by the transpose of the matrix of whiten().
  void whiten_transposed(Eigen::MatrixXd& columns) const;

  /// Range of an axis over the fit rows, and the mean distance between neighbouring different positions.
  struct Range {
    double low = 0, high = 0, step = 0;
    bool even = true;  // true: the distances are multiples of one step, or nearly so
    /// Returns `low` and `high`, rounded outwards to a thousandth of the range, so that a term has short
    /// numbers.
    std::pair<double, double> outwards() const;
  };
  Range range_of(std::size_t axis) const;
  /// True if a column of the measurement has several values over the fit rows.
  bool varies(const model::Column& column) const;
  /// Returns the positions at which an axis was read, in increasing order. Positions with a distance of at
  /// most `apart` count as one position. `sense`: +1 or -1 selects the rows with this approach direction; 0
  /// selects all rows.
  std::vector<double> places_read(std::size_t axis, int sense, double apart) const;
  /// Returns the approach direction (+1, -1) of an axis in a row: the recorded direction, else the direction
  /// from the previous rows. The approach direction is 0 if it is unknown.
  int sense_of(std::size_t axis, std::size_t row) const;
  /// Returns the change of a term if the positions on the touched objects are replaced by the recorded
  /// positions, divided by the residual of the given model. `k`: values of the linear unknowns of the term.
  /// Recorded positions contain the error of the touch. A term with a large slope repeats the touch error.
  /// share_of_touch_error() returns 0 if no row is a touch.
  double share_of_touch_error(const effects::Candidate& candidate, const std::vector<double>& scanned,
                              const Eigen::VectorXd& k) const;
  /// Returns the extent of the points that were read, mm; 0 if no lengths were read.
  double reach_mm() const { return reach_mm_; }
  Range time_range() const;

 private:
  void take_inputs();
  void respond();
  void silence_rounding();
  /// Replaces the recorded positions of touch rows by positions on the touched objects, because recorded
  /// positions contain the error of the touch.
  void take_touched_positions();
  /// Builds the columns of the unknown values of touched objects. These columns belong to the free parameters
  /// of the model.
  void take_things(const model::HeldLinearisation& held);
  void find_reach(const Eigen::VectorXd& predicted);
  void absorb();
  void share_poses(Eigen::MatrixXd& columns) const;
  void split_blocks();
  /// Returns the index of the block with which a row may be held out: the block of the row, or its run if the
  /// measurement has no blocks.
  std::size_t block_of(std::size_t row) const {
    return measurement_.states.of(measurement_.states.block, row);
  }
  /// Returns groups of two or more fit observations of one kind at one position, in any run.
  std::vector<std::vector<Eigen::Index>> readings_at_one_pose() const;
  /// Returns the fit observations of one kind during one stay at a position, for each stay.
  std::vector<std::vector<Eigen::Index>> visits() const;

  DiagnoseThresholds thresholds_;
  model::Machine machine_;
  model::Measurement measurement_;
  std::size_t declared_ = 0;  // number of inputs in the user's machine; the logged columns follow these
                              // inputs
  std::vector<effects::DofPlace> places_;
  std::vector<std::size_t> observation_, rows_;  // observation and row of each fit observation
  std::vector<std::size_t> fit_rows_;            // the rows of rows_, each once, in increasing order
  std::vector<Eigen::Index> at_fit_row_;         // index in fit_rows_ of each fit observation
  Eigen::MatrixXd response_, absorbed_;
  Eigen::VectorXd weight_, residual_;
  Eigen::MatrixXd things_;  // weighted readings per unit of each unknown value of a touched object
  std::vector<int> block_;
  std::vector<model::Column> position_;
  std::vector<std::vector<Eigen::Index>> poses_;  // groups of observations that have a common error
  std::vector<model::Column> recorded_;           // recorded positions of the axes, if positions were moved
                                                  // onto touched objects
  std::vector<int> place_;                        // index of the position of each row of the measurement
  double pose_share_ = 0;
  bool noise_known_ = false, with_u_ = false;
  std::size_t revision_ = 1;
  double stride_ = 1;  // only every stride_-th row is used
  fit::NoiseLayout layout_;
  fit::NoiseModel noise_;
  double log_determinant_ = 0, reach_mm_ = 0;
  Eigen::VectorXd raw_residual_;
  Eigen::MatrixXd raw_absorbed_;
};

/// Computes the columns of candidates on one copy of the machine, one candidate after another
/// (Evidence::columns). Use a separate ColumnMaker for each thread.
class ColumnMaker {
 public:
  explicit ColumnMaker(const Evidence& evidence);
  /// Returns the terms of a candidate in the fit rows (Evidence::fit_rows), one matrix for each term: the
  /// values per unit of each linear unknown, one column for each.
  std::vector<Eigen::MatrixXd> functions(const effects::Candidate& candidate,
                                         const std::vector<double>& scanned);
  Eigen::MatrixXd raw(const effects::Candidate& candidate, const std::vector<double>& scanned);
  /// Returns the columns of a candidate for other states of the rows.
  Eigen::MatrixXd raw_at(const effects::Candidate& candidate, const std::vector<double>& scanned,
                         const model::States& states);
  /// Returns the whitened columns of a candidate.
  Eigen::MatrixXd columns(const effects::Candidate& candidate, const std::vector<double>& scanned);

 private:
  std::vector<Eigen::MatrixXd> functions_at(const effects::Candidate& candidate,
                                            const std::vector<double>& scanned, const model::States& states);

  const Evidence& evidence_;
  model::Machine scratch_;
  std::size_t own_statics_;
};

}  // namespace vernier::diagnose
