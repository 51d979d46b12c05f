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

/// All data of a fitted machine and its rows that a search needs: the influence of each degree of freedom on
/// each observation, the residual, and the columns of the free parameters of the model.
class Evidence {
 public:
  /// `fitted`: the machine at its best fit. Every logged column becomes an input.
  Evidence(const model::Machine& fitted, const model::Measurement& measurement,
           const DiagnoseThresholds& thresholds = {});

  /// Thresholds for every part of the search.
  const DiagnoseThresholds& thresholds() const { return thresholds_; }
  const model::Machine& machine() const { return machine_; }  // with every logged column as an input
  const model::Measurement& measurement() const { return measurement_; }
  /// Returns the reference value of an input: the declared reference, 20 degC, else a round number near the
  /// mean of the input.
  double reference_of(std::size_t input) const;
  const std::vector<effects::DofPlace>& places() const { return places_; }
  std::size_t index_of(const effects::DofPlace& place) const;

  /// Returns d reading / d (mm or deg at the location), weighted by 1/u, for the fit observations.
  auto response(std::size_t place) const { return response_.col(static_cast<Eigen::Index>(place)); }
  /// Row of each fit observation.
  const std::vector<std::size_t>& rows() const { return rows_; }
  /// Returns the commanded position of an axis in each row of the measurement. Commanded positions exclude
  /// the correction: with the correction, every reading would be a separate pose.
  const model::Column& position(std::size_t axis) const { return position_[axis]; }
  const Eigen::VectorXd& weights() const { return weight_; }
  /// (measured - model) / u of the fit observations, without the part that the model can absorb.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// Returns orthonormal columns that span the changes of the readings by the free parameters.
  const Eigen::MatrixXd& absorbed() const { return absorbed_; }
  bool noise_known() const { return noise_known_; }
  double chi_square() const { return residual_.squaredNorm(); }
  double freedom() const { return static_cast<double>(residual_.size() - absorbed_.cols()); }

  /// Returns the columns of a candidate, one per linear unknown: weighted readings per unit of the unknown,
  /// without whitening. `scanned`: values of the other unknowns, in their order.
  Eigen::MatrixXd columns(const effects::Candidate& candidate, const std::vector<double>& scanned) const;

  /// Runs of the fit rows for leave-out tests: one index per fit observation. If there is only one run, the
  /// blocks are groups of successive rows.
  const std::vector<int>& blocks() const { return block_; }
  /// Returns blocks like blocks(), with every run divided into parts that are held out in turn.
  std::vector<int> parts_of_runs() const;

  /// Returns the variance of the error that readings of one kind at one pose share, divided by the variance
  /// of their differences (one-way analysis of variance, Searle 1992, 3.6). 0 if no pose was read more than
  /// once, or if the ratio is not significant. `residual`: beside the model and the orthonormal columns
  /// `fitted`.
  double shared_pose_error(const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted) const;
  /// From this call on, readings at one pose share an error. The variance of this error is `share` times the
  /// independent variance of the readings (generalised least squares). weigh_poses weights the residual, the
  /// columns and the part that the model absorbs.
  void weigh_poses(double share);
  /// True if few poses are visited twice, and u is given. The noise model then describes the errors that the
  /// readings of a stay share (NoiseModel::pose), also if u states this error.
  bool poses_are_visits() const;
  /// From this call on, the noise model `noise` gives the correlation of the readings' errors (generalised
  /// least squares). assume() whitens the residual, the columns and the columns of the model's free
  /// parameters.
  void assume(const fit::NoiseModel& noise);
  const fit::NoiseModel& noise() const { return noise_; }
  /// Increases each time that the whitening changes.
  std::size_t revision() const { return revision_; }
  /// log det of the covariance of the readings under that model.
  double log_determinant() const { return log_determinant_; }
  /// Returns the correlation of the readings' errors beside the model and the columns from `raw_columns`.
  /// `given`: steps that are assumed, with the heights that they have beside the model and these columns.
  fit::NoiseModel estimate(const Eigen::MatrixXd& raw, std::vector<fit::NoiseStep> given = {}) const;
  const fit::NoiseLayout& layout() const { return layout_; }
  /// Returns the sum of squares of the weighted residual beside the model and the columns `raw`, without
  /// whitening.
  double left_in_full(const Eigen::MatrixXd& raw) const;
  /// Returns the columns of a candidate before any whitening.
  Eigen::MatrixXd raw_columns(const effects::Candidate& candidate, const std::vector<double>& scanned) const;
  /// Returns a column for each kind of reading: the influence of one common offset, before any whitening.
  Eigen::MatrixXd offset_columns() const;
  /// The noise model for the rows of the file, if only every k-th row was used here.
  fit::NoiseModel noise_of_file() const;
  /// Applies that whitening to columns over the fit observations.
  void whiten(Eigen::MatrixXd& columns) const;

  /// Range of an axis over the fit rows, and the mean step between different values.
  struct Range {
    double low = 0, high = 0, step = 0;
    bool even = true;  // the steps are multiples of one step, or nearly so
    /// Returns low and high, rounded outwards to a thousandth of the range: a term is then readable.
    std::pair<double, double> outwards() const;
  };
  Range range_of(std::size_t axis) const;
  /// True if a column of the measurement has several values over the fit rows.
  bool varies(const model::Column& column) const;
  /// Returns the positions at which an axis was read, increasing. Positions with a distance of at most
  /// `apart` count once. sense: +1 or -1 for the rows with this approach direction, 0 for all rows.
  std::vector<double> places_read(std::size_t axis, int sense, double apart) const;
  /// Returns the approach direction of a row: as recorded, else from the rows before. The result is 0 if the
  /// approach direction is unknown.
  int sense_of(std::size_t axis, std::size_t row) const;
  /// For touches: change of a term from the positions on the touched objects to the recorded positions, over
  /// the residual of the given model. k: the linear unknowns. Recorded positions contain the error of the
  /// touch: a steep term repeats it. 0 without touches.
  double share_of_touch_error(const effects::Candidate& candidate, const std::vector<double>& scanned,
                              const Eigen::VectorXd& k) const;
  /// Extent of the points that were read, mm; 0 if no lengths were read.
  double reach_mm() const { return reach_mm_; }
  Range time_range() const;

 private:
  void take_inputs();
  void respond();
  void silence_rounding();
  /// Moves the positions of rows that touch onto what they touched: recorded positions contain the error.
  void take_touched_positions();
  /// Takes the columns of the unknown values of touched objects: the model absorbs them.
  void take_things(const model::HeldLinearisation& held);
  void find_reach(const Eigen::VectorXd& predicted);
  void absorb();
  void share_poses(Eigen::MatrixXd& columns) const;
  void split_blocks();
  /// Returns the index of the part with which a row may be held out: its block, or its run if there are no
  /// blocks.
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
  std::size_t declared_ = 0;  // inputs of the user's machine; logged columns follow them
  std::vector<effects::DofPlace> places_;
  std::vector<std::size_t> observation_, rows_;  // of the fit observations
  Eigen::MatrixXd response_, absorbed_;
  Eigen::VectorXd weight_, residual_;
  Eigen::MatrixXd things_;  // weighted readings per unit of each unknown value of a touched object
  std::vector<int> block_;
  std::vector<model::Column> position_;
  std::vector<std::vector<Eigen::Index>> poses_;  // observations that share an error
  std::vector<model::Column> recorded_;           // positions of the axes, if they were moved onto objects
  std::vector<int> place_;                        // of each row of the measurement
  double pose_share_ = 0;
  bool noise_known_ = false, with_u_ = false;
  std::size_t revision_ = 1;
  double stride_ = 1;  // of the rows that were kept
  fit::NoiseLayout layout_;
  fit::NoiseModel noise_;
  double log_determinant_ = 0, reach_mm_ = 0;
  Eigen::VectorXd raw_residual_;
  Eigen::MatrixXd raw_absorbed_;
};

/// Computes the columns of candidates one after another (Evidence::columns) on one copy of the machine. Use a
/// separate ColumnMaker for each thread.
class ColumnMaker {
 public:
  explicit ColumnMaker(const Evidence& evidence);
  Eigen::MatrixXd raw(const effects::Candidate& candidate, const std::vector<double>& scanned);
  /// Returns the columns at other states of the rows.
  Eigen::MatrixXd raw_at(const effects::Candidate& candidate, const std::vector<double>& scanned,
                         const model::States& states);
  /// Returns the whitened columns of a candidate.
  Eigen::MatrixXd columns(const effects::Candidate& candidate, const std::vector<double>& scanned);

 private:
  const Evidence& evidence_;
  model::Machine scratch_;
  std::size_t own_statics_;
};

}  // namespace vernier::diagnose
